"""A site as an MTConnect agent."""
