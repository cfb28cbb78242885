/* What hands measure, metres: all lengths of this folder are shares of these. */
#ifndef RLF_HANDS_SIZE_H
#define RLF_HANDS_SIZE_H

#define HAND_M 0.185         /* wrist to the end of the middle finger: the mean of adults */
#define HAND_LONGEST_M 0.205 /* the same, 95th percentile */
#define FINGER_M 0.016       /* breadth of a finger */

#endif
