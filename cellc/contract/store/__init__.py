"""What is kept between calls, and how files are put in place."""
