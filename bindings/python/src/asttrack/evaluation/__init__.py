"""Measuring trackers against ground truth: sequences, protocol, metrics, tables and the report."""
