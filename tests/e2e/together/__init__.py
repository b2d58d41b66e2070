"""Several people at one program."""
