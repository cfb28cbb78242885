/* Elementary functions of our own: with IEEE 754 arithmetic and no contraction they give the same
 * bits with every compiler and C library, which replays and golden hashes rely on.
 *
 * Method: argument reduction to a small interval, then the Taylor series far enough for double. */
#include "relief/math.h"

#include <string.h>

/* pi/2 in two parts (Cody and Waite 1980): the high part has 33 bits, so k * high is exact for
 * |k| < 2^20. */
#define HALF_PI_HIGH 1.57079632673412561417e+00
#define HALF_PI_LOW 6.07710050650619224932e-11
#define LN2_HIGH 6.93147180369123816490e-01
#define LN2_LOW 1.90821492927058770002e-10

/* sin of |x| <= pi/4 */
static double sin_kernel(double x)
{
    double z = x * x;
    double p = -1.0 / 1307674368000.0;
    p = p * z + 1.0 / 6227020800.0;
    p = p * z - 1.0 / 39916800.0;
    p = p * z + 1.0 / 362880.0;
    p = p * z - 1.0 / 5040.0;
    p = p * z + 1.0 / 120.0;
    p = p * z - 1.0 / 6.0;
    return x + x * z * p;
}

/* cos of |x| <= pi/4 */
static double cos_kernel(double x)
{
    double z = x * x;
    double p = 1.0 / 20922789888000.0;
    p = p * z - 1.0 / 87178291200.0;
    p = p * z + 1.0 / 479001600.0;
    p = p * z - 1.0 / 3628800.0;
    p = p * z + 1.0 / 40320.0;
    p = p * z - 1.0 / 720.0;
    p = p * z + 1.0 / 24.0;
    return 1.0 - 0.5 * z + z * z * p;
}

static double sin_quadrant(double x, int shift)
{
    if (!(x >= -1e5 && x <= 1e5)) {
        return 0.0;
    }
    double k = x * (2.0 / RLF_PI);
    int32_t n = (int32_t)(k < 0.0 ? k - 0.5 : k + 0.5);
    double r = (x - n * HALF_PI_HIGH) - n * HALF_PI_LOW;
    switch ((n + shift) & 3) {
    case 0: return sin_kernel(r);
    case 1: return cos_kernel(r);
    case 2: return -sin_kernel(r);
    default: return -cos_kernel(r);
    }
}

double rlf_sin(double x)
{
    return sin_quadrant(x, 0);
}
double rlf_cos(double x)
{
    return sin_quadrant(x, 1);
}

/* 2^n for -1022 <= n <= 1023 */
static double power_of_two(int32_t n)
{
    uint64_t bits = (uint64_t)(n + 1023) << 52;
    double result;
    memcpy(&result, &bits, sizeof(result));
    return result;
}

double rlf_exp(double x)
{
    if (!(x > -708.0)) {
        return 0.0;
    }
    if (x > 709.0) {
        x = 709.0;
    }
    double k = x * 1.44269504088896340736;
    int32_t n = (int32_t)(k < 0.0 ? k - 0.5 : k + 0.5);
    double r = (x - n * LN2_HIGH) - n * LN2_LOW;
    double sum = 1.0;
    for (int32_t i = 16; i >= 1; i--) {
        sum = 1.0 + r * sum / i;
    }
    return sum * power_of_two(n);
}

double rlf_log_e(double x)
{
    if (!(x > 0.0)) {
        return -708.0;
    }
    if (x < 1e-300) {
        x = 1e-300;
    }
    uint64_t bits;
    memcpy(&bits, &x, sizeof(bits));
    int32_t n = (int32_t)(bits >> 52) - 1023;
    bits = (bits & 0x000fffffffffffffu) | 0x3ff0000000000000u;
    double m;
    memcpy(&m, &bits, sizeof(m));
    if (m > 1.41421356237309504880) {
        m *= 0.5;
        n++;
    }
    /* log m = 2 artanh s, s = (m-1)/(m+1), |s| < 0.172 */
    double s = (m - 1.0) / (m + 1.0);
    double z = s * s;
    double sum = 0.0;
    for (int32_t i = 21; i >= 3; i -= 2) {
        sum = (sum + 1.0 / i) * z;
    }
    return n * LN2_HIGH + (n * LN2_LOW + 2.0 * s * (1.0 + sum));
}

/* atan of 0 <= x <= 1, reduced to |t| <= tan(pi/16) by two half-angle steps. */
static double atan_unit(double x)
{
    for (int32_t i = 0; i < 2; i++) {
        x = x / (1.0 + sqrt(1.0 + x * x));
    }
    double z = x * x;
    double sum = 0.0;
    for (int32_t i = 25; i >= 1; i -= 2) {
        sum = 1.0 / i - z * sum;
    }
    return 4.0 * x * sum;
}

double rlf_atan2(double y, double x)
{
    double ax = x < 0.0 ? -x : x;
    double ay = y < 0.0 ? -y : y;
    if (!(ax + ay > 0.0)) {
        return 0.0;
    }
    double a = ay <= ax ? atan_unit(ay / ax) : RLF_PI / 2 - atan_unit(ax / ay);
    if (x < 0.0) {
        a = RLF_PI - a;
    }
    return y < 0.0 ? -a : a;
}

double rlf_acos(double x)
{
    x = rlf_clamp(x, -1.0, 1.0);
    return rlf_atan2(sqrt((1.0 - x) * (1.0 + x)), x);
}
