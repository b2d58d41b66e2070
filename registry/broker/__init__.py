"""Which accounts the MQTT broker knows, whichever broker it is."""
