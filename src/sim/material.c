/* Procedural textures. Coordinates are metres in the shape's own frame. */
#include "sim/material.h"

static rlf_vec3 rgb(double r, double g, double b)
{
    return rlf_vec3_make(r, g, b);
}

static rlf_vec3 mix(rlf_vec3 a, rlf_vec3 b, double t)
{
    return rlf_add(a, rlf_scale(rlf_sub(b, a), t));
}

static double absolute(double x)
{
    return x < 0.0 ? -x : x;
}

static int32_t floor_of(double x)
{
    int32_t i = (int32_t)x;
    return x < i ? i - 1 : i;
}

static double fraction(double x)
{
    return x - floor_of(x);
}

/* Wood whose grain runs along `along`. */
static rlf_vec3 wood(rlf_vec3 light, rlf_vec3 dark, double along, double across)
{
    double wave = synth_value_noise(along * 2.5, across * 22.0);
    double fine = synth_value_noise(along * 14.0, across * 190.0);
    double ring = fraction(3.0 * synth_value_noise(along * 0.9, across * 9.0));
    double t = 0.45 * wave + 0.25 * fine + 0.3 * ring;
    return mix(light, dark, t);
}

/* Oak boards 16 cm wide and 1.3 m long, with a dark gap. */
static rlf_vec3 floor_boards(double x, double z)
{
    const double width = 0.16;
    const double length = 1.3;
    int32_t row = floor_of(z / width);
    double shifted = x / length + synth_lattice(row, 77);
    int32_t board = floor_of(shifted);
    double tone = synth_lattice(row, board);
    rlf_vec3 light = mix(rgb(0.50, 0.31, 0.165), rgb(0.40, 0.225, 0.11), tone);
    rlf_vec3 color = wood(light, rlf_scale(light, 0.62), x + 3.0 * tone, z + 7.0 * tone);
    double gap_z = (0.5 - absolute(fraction(z / width) - 0.5)) * width;
    double gap_x = (0.5 - absolute(fraction(shifted) - 0.5)) * length;
    double gap = rlf_min(gap_x, gap_z);
    return gap < 0.0022 ? rlf_scale(color, 0.35) : color;
}

/* Polished dark tiles of 30 cm with light joints. */
static rlf_vec3 floor_tiles(double x, double z)
{
    const double side = 0.3;
    double tone = synth_lattice(floor_of(x / side), floor_of(z / side));
    double cloud = synth_value_noise(x * 11.0, z * 11.0);
    double joint =
        rlf_min(0.5 - absolute(fraction(x / side) - 0.5), 0.5 - absolute(fraction(z / side) - 0.5));
    rlf_vec3 tile = rlf_scale(rgb(0.135, 0.15, 0.165), 0.75 + 0.25 * tone + 0.25 * cloud);
    return joint * side < 0.003 ? rgb(0.28, 0.28, 0.27) : tile;
}

/* Hills and a sun in a wooden frame; u and v run from -1 to 1, v upwards. */
static rlf_vec3 picture(double u, double v)
{
    if (absolute(u) > 0.93 || absolute(v) > 0.905) {
        return wood(rgb(0.20, 0.11, 0.05), rgb(0.10, 0.05, 0.025), u, v);
    }
    if (absolute(u) > 0.83 || absolute(v) > 0.76) {
        return rgb(0.82, 0.80, 0.74);
    }
    double sun = (u - 0.32) * (u - 0.32) * 1.9 + (v - 0.22) * (v - 0.22);
    double far_hill = 0.02 + 0.16 * rlf_sin(3.2 * u + 0.5) + 0.05 * rlf_sin(9.0 * u);
    double near_hill = -0.30 + 0.15 * rlf_sin(2.6 * u + 2.6);
    if (v < near_hill) {
        return rgb(0.045, 0.115, 0.105);
    }
    if (v < far_hill) {
        return rgb(0.10, 0.25, 0.235);
    }
    if (sun < 0.042) {
        return rgb(0.93, 0.42, 0.10);
    }
    return mix(rgb(0.92, 0.68, 0.40), rgb(0.36, 0.52, 0.62), rlf_clamp(0.75 * v + 0.3, 0.0, 1.0));
}

/* Plaster, a skirting board along the floor, a picture; `up` is height relative to the camera. */
static rlf_vec3 wall(double x, double up)
{
    double u = (x + 0.22) / 0.40;
    double v = (up - 0.50) / 0.30;
    if (absolute(u) <= 1.0 && absolute(v) <= 1.0) {
        return picture(u, v);
    }
    if (up < -1.2) {
        return up > -1.207 ? rgb(0.35, 0.34, 0.32) : rgb(0.78, 0.77, 0.74);
    }
    double tone = 0.97 + 0.03 * synth_value_noise(x * 3.0, up * 3.0) +
                  0.02 * synth_value_noise(x * 60.0, up * 60.0);
    return rlf_scale(rgb(0.60, 0.66, 0.64), tone);
}

static rlf_vec3 cupboard(rlf_vec3 local, rlf_vec3 size)
{
    rlf_vec3 paint = wood(rgb(0.72, 0.69, 0.62), rgb(0.62, 0.59, 0.52), local.y, local.x);
    if (local.z > -size.z + 1e-4) {
        return paint;
    }
    double x = absolute(local.x);
    double middle = absolute(local.y - 0.35);
    if (x < 0.004 || middle < 0.004) {
        return rlf_scale(paint, 0.3);
    }
    bool is_handle = x > 0.035 && x < 0.055 && middle > 0.08 && middle < 0.22;
    if (is_handle) {
        return rgb(0.09, 0.09, 0.10);
    }
    double panel = rlf_min(rlf_min(size.x - x, x), rlf_min(size.y - absolute(local.y), middle));
    return panel > 0.075 && panel < 0.083 ? rlf_scale(paint, 0.7) : paint;
}

static rlf_vec3 cardboard(rlf_vec3 local)
{
    double flute = 0.94 + 0.06 * synth_value_noise(local.x * 9.0, local.y * 160.0);
    if (absolute(local.x) < 0.026 && local.y < 0.035) {
        return rgb(0.60, 0.50, 0.30);
    }
    return rlf_scale(rgb(0.42, 0.275, 0.15), flute);
}

/* Six sectors and two caps. */
static rlf_vec3 ball(rlf_vec3 local)
{
    double height = local.y / 0.14;
    if (absolute(height) > 0.93) {
        return rgb(0.85, 0.85, 0.82);
    }
    double sector = (rlf_atan2(local.x, local.z) / RLF_PI + 1.0) * 3.0;
    static const double colors[3][3] = {{0.80, 0.08, 0.06}, {0.86, 0.86, 0.83}, {0.05, 0.20, 0.62}};
    const double *c = colors[floor_of(sector) % 3];
    return rgb(c[0], c[1], c[2]);
}

/* The head's frame is upright with y down and z ahead; size 0.076 x 0.112 x 0.094. */
static rlf_vec3 face(rlf_vec3 p, rlf_vec3 own)
{
    rlf_vec3 skin = own.x > 0.0 ? own : rgb(0.62, 0.36, 0.24);
    if (p.z < 0.0) {
        return skin;
    }
    double x = absolute(p.x);
    double eye = (x - 0.031) * (x - 0.031) * 0.7 + (p.y + 0.012) * (p.y + 0.012);
    if (eye < 0.00003) {
        return rgb(0.03, 0.02, 0.02);
    }
    if (eye < 0.00009) {
        return rgb(0.75, 0.72, 0.70);
    }
    if (x > 0.016 && x < 0.047 && absolute(p.y + 0.030 + 0.1 * (x - 0.03)) < 0.0035) {
        return rgb(0.07, 0.04, 0.025);
    }
    if (x < 0.024 && absolute(p.y - 0.052 + 4.0 * x * x) < 0.004) {
        return rgb(0.42, 0.12, 0.10);
    }
    return skin;
}

static rlf_vec3 shirt(const synth_part *part, rlf_vec3 local)
{
    rlf_vec3 cloth = rgb(0.50, 0.085, 0.065);
    bool is_trunk = part->shape.type == SYNTH_ELLIPSOID;
    double up =
        part->shape.size.y > 0.19 ? -local.y : -local.y - 0.19; /* above the chest's middle */
    if (is_trunk && up > -0.015 && up < 0.035) {
        return rgb(0.80, 0.76, 0.68);
    }
    return cloth;
}

static rlf_vec3 book(rlf_vec3 local)
{
    bool is_cover = absolute(local.z) > 0.0123 || local.x < -0.084;
    if (!is_cover) {
        return rlf_scale(rgb(0.80, 0.77, 0.68),
                         0.85 + 0.15 * synth_value_noise(local.z * 900.0, 0.0));
    }
    if (absolute(local.x) < 0.055 && local.y > -0.085 && local.y < -0.045) {
        return rgb(0.85, 0.68, 0.25);
    }
    return rgb(0.03, 0.16, 0.34);
}

rlf_vec3 synth_albedo(const synth_part *part, rlf_vec3 p)
{
    switch (part->material) {
    case SYNTH_WALL: return wall(p.x, p.z);
    case SYNTH_FLOOR: return floor_boards(p.x, p.z);
    case SYNTH_TILES: return floor_tiles(p.x, p.z);
    case SYNTH_RUBBER: return rgb(0.035, 0.035, 0.04);
    case SYNTH_CEILING: return rgb(0.80, 0.80, 0.78);
    case SYNTH_COLUMN:
        return rlf_scale(rgb(0.74, 0.70, 0.62), 0.96 + 0.04 * synth_value_noise(p.x * 8, p.y * 8));
    case SYNTH_CUPBOARD: return cupboard(p, part->shape.size);
    case SYNTH_TABLE: return wood(rgb(0.47, 0.27, 0.13), rgb(0.27, 0.135, 0.06), p.x, p.z + p.y);
    case SYNTH_CARDBOARD: return cardboard(p);
    case SYNTH_BOX_RED: return absolute(p.x) < 0.012 ? rgb(0.85, 0.72, 0.3) : rgb(0.60, 0.06, 0.07);
    case SYNTH_BOX_TEAL: return absolute(p.y) < 0.02 ? rgb(0.8, 0.8, 0.75) : rgb(0.03, 0.33, 0.34);
    case SYNTH_BALL: return ball(p);
    case SYNTH_CHAIR: return wood(rgb(0.30, 0.19, 0.11), rgb(0.20, 0.12, 0.07), p.y, p.x + p.z);
    case SYNTH_FACE: return face(p, part->look.color);
    case SYNTH_HAIR: return rgb(0.055, 0.032, 0.020);
    case SYNTH_SHIRT: return shirt(part, p);
    case SYNTH_TROUSERS: return rgb(0.045, 0.075, 0.155);
    case SYNTH_SHOE:
        return p.x > 0.030 || p.x < -0.030 ? rgb(0.6, 0.6, 0.6) : rgb(0.06, 0.06, 0.07);
    case SYNTH_BOOK: return book(p);
    case SYNTH_DRAWN: return synth_look_albedo(&part->look, p);
    default: return rgb(0.62, 0.36, 0.24);
    }
}

double synth_infrared(const synth_part *part)
{
    static const double reflectance[SYNTH_MATERIAL_COUNT] = {
        [SYNTH_WALL] = 0.6,     [SYNTH_FLOOR] = 0.45,   [SYNTH_TILES] = 0.45,
        [SYNTH_RUBBER] = 0.072, [SYNTH_CEILING] = 0.6,  [SYNTH_COLUMN] = 0.6,
        [SYNTH_CUPBOARD] = 0.5, [SYNTH_TABLE] = 0.45,   [SYNTH_CARDBOARD] = 0.5,
        [SYNTH_BOX_RED] = 0.45, [SYNTH_BOX_TEAL] = 0.4, [SYNTH_BALL] = 0.5,
        [SYNTH_CHAIR] = 0.4,    [SYNTH_SKIN] = 0.5,     [SYNTH_FACE] = 0.5,
        [SYNTH_HAIR] = 0.15,    [SYNTH_SHIRT] = 0.45,   [SYNTH_TROUSERS] = 0.35,
        [SYNTH_SHOE] = 0.2,     [SYNTH_BOOK] = 0.4,
    };
    return part->material == SYNTH_DRAWN ? part->look.reflectance : reflectance[part->material];
}

void synth_gamma_table(uint8_t table[SYNTH_GAMMA_SIZE])
{
    for (int i = 0; i < SYNTH_GAMMA_SIZE; i++) {
        double linear = (i + 0.5) / SYNTH_GAMMA_SIZE;
        double code =
            linear <= 0.0031308 ? 12.92 * linear : 1.055 * rlf_exp(rlf_log_e(linear) / 2.4) - 0.055;
        table[i] = (uint8_t)(code * 255.0 + 0.5);
    }
}
