"""What is really there: the links of the cell, where its joints have been, and objects that can be grasped."""
