"""What the named effects leave: is it a function of the state or of time, a burst, or noise?"""
