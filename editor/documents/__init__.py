"""editor.documents."""
