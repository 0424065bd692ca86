"""What a camera sees of gown and person: states of the room, labelled pictures, one small network."""
