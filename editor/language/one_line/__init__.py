"""editor.language.one_line."""
