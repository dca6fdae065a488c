"""How quick the studio is."""
