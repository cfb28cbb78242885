/* Six linear equations, for a rigid motion's six unknowns. */
#ifndef RLF_MATH_SOLVE_SIX_H
#define RLF_MATH_SOLVE_SIX_H

/* Solves a x = b for a symmetric positive definite matrix of which the lower triangle is read, and
 * which is destroyed: Cholesky's L L^T. */
void math_solve_six(double a[6][6], const double b[6], double x[6]);

#endif
