"""Files of motions: BVH, npz, keypoints, HumanML3D, and how those of others are read."""
