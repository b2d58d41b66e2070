"""The site that a program is checked against: its devices, places and library as plain data."""
