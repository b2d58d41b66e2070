"""What is found by following a program: where robots stand, what they carry."""
