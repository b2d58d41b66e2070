"""Programs promoted to other sites: who there can stand for whom, and the program made of what was chosen."""
