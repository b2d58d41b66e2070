"""Devices as rows: descriptions, states, readings, enrolment, and what admins decide about them."""
