"""Two documents compared: what has changed, value by value and construct by construct, and how it is taken back."""
