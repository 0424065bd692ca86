"""Payloads that change within a recording, or from one to the next: when each acts, and what it is."""
