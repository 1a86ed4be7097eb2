"""Write the generated folder, or tell how it differs from what a build would write."""
