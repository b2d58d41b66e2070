"""What is wrong with a program, or odd about it, by subject."""
