"""Accounts: coming in by a provider, and the second factor that a site demands."""
