"""The gates of bring-up for one cell, as the checklists and the page that leads through them state them."""
