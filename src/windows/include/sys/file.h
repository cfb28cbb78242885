/* flock: windows/posix.h, which every source has. */
