"""What people want to happen: the language, the shared documents, and programs with their versions."""
