"""Rules on frames and calibration."""
