"""A program while people edit it together: its members, their messages, and what passes between processes."""
