"""Command line of the generator."""

import sys

from .build import main

sys.exit(main())
