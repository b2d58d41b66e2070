"""Single sign-on by OpenID Connect: providers, what is said to them, and which account of theirs is whose."""
