"""Every number the verdict turns on, in one place.

They were chosen on the even seeds of `caretree gap bench` and then left alone; the odd seeds are what is reported.
"""

from __future__ import annotations

ALPHA = 0.05  # chance of a false alarm over the whole set, all hypotheses together
MATERIAL = 0.12  # an effect's own part must reach this size, in units of what the model leaves
SHARE = 0.008  # and at least this part of the energy explained in the channel it helps most,
LEFT = 0.5  # or this part of what is left there without it: much, beside something larger by far
CROSS = 0.3  # part of a step's gain that must survive on unseen folds
REMAINDER = 0.06  # `unknown` above this part of the explainable energy left unexplained
MOST = 0.8  # or above this part of what is left in a channel, if that is also `SHARE` of what is explained
REMAINDER_SIZE = 0.08  # energy of a predictable leftover over the floor's before it counts
BURST_SHARE = 0.35  # part of a channel's leftover that bursts must hold before they are called contact
CONFIDENCE = 0.8  # part of the bootstrap resamples that must keep an effect
TRANSFER = 3.0  # held-out energy over the worst fitted log's from which on an explanation is asked if it holds there
