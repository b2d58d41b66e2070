"""Single sign-on against a real provider."""
