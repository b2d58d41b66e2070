"""Tests of programs: files that say what is given, what happens and what then holds; rehearsed in virtual time."""
