"""What rays of a block say: stereo models, coplanarity, points on the ground."""
