# SPDX-License-Identifier: CC0-1.0
"""Small solid modeller behind the shipped models and environments (standard library only)."""
