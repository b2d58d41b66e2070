"""Sites, their maps, places and members."""
