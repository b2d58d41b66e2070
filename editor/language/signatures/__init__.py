"""What programs and functions need of devices, whether another version fits, and who can stand in. Pure."""
