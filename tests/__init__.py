"""Tests of risorius; the folders mirror `src/risorius`."""
