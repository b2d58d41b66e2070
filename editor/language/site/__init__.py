"""What a program is checked against: devices and places as plain data."""
