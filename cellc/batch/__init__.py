"""Answers for the specs of one call: kept ones where nothing changed, the others computed, by several processes where
that pays. Importing it loads no stage of the compiler, and a call that finds all answers kept never does."""
