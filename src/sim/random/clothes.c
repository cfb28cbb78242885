/* What people wear beside trousers and a shirt, and their hands' fingers. */
#include "sim/bones.h"
#include "sim/random/plan.h"

/* Sizes are those of an adult of 1.75 m, bone frame. */
static synth_flesh *wear(synth_individual *p, const char *name, int bone, synth_material material,
                         synth_shape_type type, rlf_vec3 at)
{
    synth_flesh *f = &p->flesh[p->flesh_count++];
    *f =
        (synth_flesh){.name = name, .bone = bone, .material = material, .type = type, .offset = at};
    f->axis = 'y';
    return f;
}

static void wear_round(synth_individual *p, const char *name, int bone, synth_material material,
                       rlf_vec3 at, double length, double above, double below)
{
    synth_flesh *f = wear(p, name, bone, material, SYNTH_FRUSTUM, at);
    f->length = length;
    f->radius_a = above;
    f->radius_b = below;
}

static void wear_coat(synth_individual *p, synth_draw *d)
{
    const double s = p->figure.leg, wide = p->figure.flesh[0].size.x;
    wear_round(p, "coat", SYNTH_PELVIS, SYNTH_SHIRT, rlf_vec3_make(0, -0.34 * s, 0),
               s * synth_draw_range(d, 0.6, 0.85), 0.84 * wide,
               wide + s * synth_draw_range(d, 0.06, 0.14));
}

static void wear_skirt(synth_individual *p, synth_draw *d)
{
    const double s = p->figure.leg, wide = p->figure.flesh[0].size.x;
    wear_round(p, "skirt", SYNTH_PELVIS, SYNTH_TROUSERS, rlf_vec3_make(0, -0.1 * s, 0),
               s * synth_draw_range(d, 0.4, 0.75), 0.88 * wide,
               wide + s * synth_draw_range(d, 0.05, 0.18));
}

static void wear_hat(synth_individual *p, synth_draw *d)
{
    const rlf_vec3 head = p->figure.flesh[5].size;
    const double top = -p->figure.flesh[5].offset.y + 0.6 * head.y;
    const double brim = head.z * synth_draw_range(d, 1.1, 2.0);
    wear_round(p, "hat", SYNTH_HEAD, SYNTH_BALL, rlf_vec3_make(0, -top, 0.01), 0.012, brim, brim);
    wear_round(p, "hat", SYNTH_HEAD, SYNTH_BALL, rlf_vec3_make(0, -top - 0.1, 0.01), 0.1,
               0.95 * head.z, 1.08 * head.z);
}

static void wear_long_hair(synth_individual *p)
{
    const rlf_vec3 head = p->figure.flesh[5].size;
    synth_flesh *f = wear(p, "long hair", SYNTH_HEAD, SYNTH_HAIR, SYNTH_ELLIPSOID,
                          rlf_vec3_make(0, -0.8 * head.y, -0.45 * head.z));
    f->size = rlf_vec3_make(1.15 * head.x, 1.6 * head.y, 0.75 * head.z);
}

static void wear_backpack(synth_individual *p, synth_draw *d)
{
    const double s = p->figure.trunk, back = p->figure.flesh[2].size.z;
    const double thick = s * synth_draw_range(d, 0.06, 0.11);
    synth_flesh *f = wear(p, "backpack", SYNTH_CHEST, SYNTH_CUPBOARD,
                          synth_draw_chance(d, 0.5) ? SYNTH_BOX : SYNTH_ELLIPSOID,
                          rlf_vec3_make(0, -0.32 * s, -back - 0.6 * thick));
    f->size = rlf_vec3_make(0.15 * s, 0.21 * s, thick);
}

/* Four fingers in place of one solid, spread a little. */
static void spread_fingers(synth_individual *p)
{
    static const double length[4] = {0.065, 0.075, 0.07, 0.055};
    const double s = p->figure.arm;
    for (int32_t side = 0; side < 2; side++) {
        const int32_t from = 20 + side; /* the fingers of synth_person_flesh */
        for (int32_t i = 0; i < 4; i++) {
            const double across = (side == 0 ? 1.0 : -1.0) * (0.033 - 0.022 * i) * s;
            const rlf_vec3 at = {across, 0.088 * s, -0.004 * s};
            synth_flesh *f = i == 0
                                 ? &p->flesh[from]
                                 : wear(p, "finger", SYNTH_PALM + side, SYNTH_SKIN, SYNTH_CONE, at);
            f->type = SYNTH_CONE;
            f->offset = at;
            f->length = s * length[i];
            f->radius_a = 0.0095 * s;
            f->radius_b = 0.008 * s;
        }
    }
}

static rlf_vec3 skin_of(synth_draw *d)
{
    const double tone = synth_draw_range(d, 0.18, 1.1);
    return rlf_vec3_make(0.66 * tone, 0.40 * tone, 0.27 * tone);
}

static void draw_looks(synth_individual *p, synth_draw *d)
{
    const double grey = synth_draw_range(d, 0.01, 0.3);
    const rlf_vec3 hair = {grey, 0.7 * grey, 0.45 * grey};
    const rlf_vec3 black = {0.04, 0.04, 0.05};
    p->looks[SYNTH_SKIN] = synth_look_plain(skin_of(d), 0.5, 0.5);
    p->looks[SYNTH_FACE] = p->looks[SYNTH_SKIN];
    p->looks[SYNTH_HAIR] = synth_look_plain(hair, synth_draw_range(d, 0.008, 0.16), 0.5);
    p->looks[SYNTH_SHIRT] = synth_look_cloth(d);
    p->looks[SYNTH_TROUSERS] = synth_look_cloth(d);
    p->looks[SYNTH_BALL] = synth_look_cloth(d);     /* the hat */
    p->looks[SYNTH_CUPBOARD] = synth_look_cloth(d); /* the backpack */
    p->looks[SYNTH_SHOE] = synth_look_plain(black, synth_draw_range(d, 0.02, 0.25), 0.4);
    for (int32_t i = 0; i < SYNTH_MATERIAL_COUNT; i++) {
        p->looks[i].texture = p->looks[i].texture < 0.45f ? 0.45f : p->looks[i].texture; /* folds */
    }
}

/* Long sleeves over bare arms, and wide trousers. */
static void widen_cloth(synth_individual *p, bool has_sleeves, bool is_wide)
{
    for (int32_t i = 0; i < SYNTH_PERSON_FLESH; i++) {
        synth_flesh *f = &p->flesh[i];
        const bool is_sleeve = f->bone == SYNTH_FOREARM || f->bone == SYNTH_FOREARM + 1;
        const bool is_leg = f->material == SYNTH_TROUSERS && f->type == SYNTH_CONE;
        if (is_sleeve && has_sleeves) {
            f->material = SYNTH_SHIRT;
            f->radius_a += 0.008;
            f->radius_b += 0.010;
        }
        if (is_leg && is_wide) {
            f->radius_a *= 1.12;
            f->radius_b *= 1.35;
        }
    }
}

void synth_draw_clothes(synth_individual *p, synth_draw *d)
{
    for (int32_t i = 0; i < SYNTH_PERSON_FLESH; i++) {
        p->flesh[i] = p->figure.flesh[i];
    }
    p->flesh_count = SYNTH_PERSON_FLESH;
    draw_looks(p, d);
    const bool has_sleeves = synth_draw_chance(d, 0.6), is_wide = synth_draw_chance(d, 0.3);
    widen_cloth(p, has_sleeves, is_wide);
    if (synth_draw_chance(d, 0.75)) {
        spread_fingers(p);
    }
    const double garment = synth_draw_range(d, 0.0, 1.0);
    if (garment < 0.25) {
        wear_coat(p, d);
    } else if (garment < 0.45) {
        wear_skirt(p, d);
    }
    if (synth_draw_chance(d, 0.25)) {
        wear_hat(p, d);
    }
    if (synth_draw_chance(d, 0.3)) {
        wear_long_hair(p);
    }
    if (synth_draw_chance(d, 0.25)) {
        wear_backpack(p, d);
    }
}
