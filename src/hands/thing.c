/* A thing that is no hand: one bent surface, and a convex outline. */
#include "hands/gesture.h"

#include <string.h>

#define TERMS 6            /* of a surface of second order over the picture */
#define ROUNDS 3           /* of weights: each leaves strays out further */
#define EMPTY_ENERGY 100.0 /* of an outline whose middles are all empty */
#define EMPTY_M 0.02       /* a middle is empty where the camera sees so far behind the pair */

/* Metres beside the first sample, and across. */
static void terms_of(const hand_crop *c, int32_t i, double out[TERMS])
{
    const double x = (double)(c->x[i] - c->x[0]) / 0.1, y = (double)(c->y[i] - c->y[0]) / 0.1;
    out[0] = 1.0;
    out[1] = x;
    out[2] = y;
    out[3] = x * x;
    out[4] = x * y;
    out[5] = y * y;
}

static void solve(double a[TERMS][TERMS], double *b)
{
    for (int32_t k = 0; k < TERMS; k++) {
        const double pivot = rlf_max(a[k][k], 1e-9);
        for (int32_t i = k + 1; i < TERMS; i++) {
            const double share = a[i][k] / pivot;
            for (int32_t j = k; j < TERMS; j++) {
                a[i][j] -= share * a[k][j];
            }
            b[i] -= share * b[k];
        }
    }
    for (int32_t k = TERMS - 1; k >= 0; k--) {
        for (int32_t j = k + 1; j < TERMS; j++) {
            b[k] -= a[k][j] * b[j];
        }
        b[k] /= rlf_max(a[k][k], 1e-9);
    }
}

/* Energy of the surface, by depth. */
static double surface_energy(const hand_crop *c)
{
    double fit[TERMS] = {0}, t[TERMS], energy = 0.0;
    for (int32_t round = 0; round < ROUNDS; round++) {
        double a[TERMS][TERMS], b[TERMS] = {0};
        memset(a, 0, sizeof(a));
        energy = 0.0;
        for (int32_t i = 0; i < c->count; i++) {
            double at = 0.0, less = 1.0;
            terms_of(c, i, t);
            for (int32_t k = 0; k < TERMS; k++) {
                at += fit[k] * t[k];
            }
            if (round > 0) {
                energy += hand_fit_robust(c, (double)c->p_z[i] - at, &less);
            }
            for (int32_t k = 0; k < TERMS; k++) {
                for (int32_t j = 0; j < TERMS; j++) {
                    a[k][j] += less * t[k] * t[j];
                }
                b[k] += less * t[k] * (double)c->p_z[i];
            }
        }
        solve(a, b);
        memcpy(fit, b, sizeof(fit));
    }
    return energy / c->count;
}

/* Share of pairs of samples between which the camera sees past the thing. */
static double gaps(const hand_crop *c)
{
    int32_t empty = 0, pairs = 0;
    for (int32_t i = 0; i < c->count; i++) {
        const int32_t k = (i + c->count / 2 + i % 7 * 11) % c->count;
        const double x = 0.5 * (double)(c->x[i] + c->x[k]), y = 0.5 * (double)(c->y[i] + c->y[k]);
        const double z = 0.5 * (double)(c->p_z[i] + c->p_z[k]);
        const int32_t u = (int32_t)(c->fx * x / z + c->cx + 0.5);
        const int32_t v = (int32_t)(c->fy * y / z + c->cy + 0.5);
        if (u >= 0 && v >= 0 && u < c->width && v < c->height) {
            const int32_t at = v * c->width + u;
            empty += c->is_hand[at] == 0 && (double)c->z[at] > z + EMPTY_M;
            pairs++;
        }
    }
    return pairs > 0 ? (double)empty / pairs : 0.0;
}

double hand_likeness_of_thing(const hand_crop *crop)
{
    return surface_energy(crop) + EMPTY_ENERGY * gaps(crop);
}
