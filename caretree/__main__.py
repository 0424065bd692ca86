"""`python -m caretree`: the command line where `caretree` is not on the path."""

import sys

from caretree.trees.cli import main

sys.exit(main())
