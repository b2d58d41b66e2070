"""What every program that plays a device needs: its connection, keys, enrolment, answers to commands."""
