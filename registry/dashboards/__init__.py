"""What dashboards and other programs of members hear of a site at the MQTT broker, and who lets them in."""
