"""What a device and VIPO say to each other, and what whoever plays a device needs. Knows nothing of the apps."""
