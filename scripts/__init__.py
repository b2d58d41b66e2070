"""Commands for whoever works on VIPO: pages and pictures written from the code, and mutation tests."""
