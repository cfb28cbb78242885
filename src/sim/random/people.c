/* Who walks, stands, reaches and sits in the room. */
#include "sim/bones.h"
#include "sim/random/plan.h"

#define TRIES 80
#define APART 0.75 /* metres between the places where two people stop */
#define STOOL_BACK                                                                                 \
    0.40 /* metres from the feet of who sits to the middle of the seat, of an adult */

typedef struct place {
    double x, z;
} place;

/* Whether a person of that height would be wholly outside the picture, or his chest and hips in. */
static bool is_out_of_view(const synth_plan *plan, place p, double height)
{
    bool is_out = true;
    for (int32_t i = 0; i <= 4 && is_out; i++) {
        is_out = !synth_place_is_seen(plan, rlf_vec3_make(p.x, height * i / 4.0, p.z), -0.35);
    }
    return is_out;
}

static bool is_in_view(const synth_plan *plan, place p, double height)
{
    const double away = sqrt(p.x * p.x + p.z * p.z);
    return away > 1.0 && away < 0.8 * plan->random->max_m &&
           synth_place_is_seen(plan, rlf_vec3_make(p.x, 0.75 * height, p.z), 0.05) &&
           synth_place_is_seen(plan, rlf_vec3_make(p.x, 0.45 * height, p.z), 0.05);
}

static place draw_place(synth_plan *plan)
{
    const synth_plot *r = &plan->room;
    const double off = 0.4;
    return (place){synth_draw_range(&plan->draw, r->x0 + off, r->x1 - off),
                   synth_draw_range(&plan->draw, r->z0 + off, r->z1 - off)};
}

static bool is_lane_free(const synth_plan *plan, const synth_lane *lane)
{
    bool is_free = synth_place_from_lane(lane, 0.0, 0.0) > 0.55;
    for (int32_t i = 0; i < plan->lane_count && is_free; i++) {
        const synth_lane *other = &plan->lanes[i];
        is_free = synth_place_from_lane(lane, other->to_x, other->to_z) > APART &&
                  synth_place_from_lane(other, lane->to_x, lane->to_z) > APART;
    }
    for (int32_t i = 0; i <= 20 && is_free; i++) {
        const double x = lane->from_x + (lane->to_x - lane->from_x) * i / 20.0;
        const double z = lane->from_z + (lane->to_z - lane->from_z) * i / 20.0;
        for (int32_t k = 0; k < plan->taken_count && is_free; k++) {
            const synth_plot *t = &plan->taken[k];
            is_free = x < t->x0 - 0.3 || x > t->x1 + 0.3 || z < t->z0 - 0.3 || z > t->z1 + 0.3;
        }
    }
    return is_free;
}

static bool draw_lane(synth_plan *plan, double height, synth_lane *out)
{
    for (int32_t i = 0; i < TRIES; i++) {
        const place stop = draw_place(plan);
        if (!is_in_view(plan, stop, height)) {
            continue;
        }
        for (int32_t k = 0; k < 12; k++) {
            const place from = draw_place(plan);
            const double dx = from.x - stop.x, dz = from.z - stop.z;
            *out = (synth_lane){from.x, from.z, stop.x, stop.z};
            if (dx * dx + dz * dz > 1.0 && is_out_of_view(plan, from, height) &&
                is_lane_free(plan, out)) {
                return true;
            }
        }
    }
    return false;
}

static double nearest_turn(double from, double to)
{
    while (to - from > RLF_PI) {
        to -= 2.0 * RLF_PI;
    }
    while (to - from < -RLF_PI) {
        to += 2.0 * RLF_PI;
    }
    return to;
}

/* Comes along the lane, turns, reaches or not, turns, and goes back. */
static void draw_script(synth_individual *person, synth_draw *d, const synth_lane *lane)
{
    const double dx = lane->from_x - lane->to_x, dz = lane->from_z - lane->to_z;
    const double length = sqrt(dx * dx + dz * dz), yaw = rlf_atan2(-dz, dx);
    const double facing = rlf_atan2(-lane->to_x, -lane->to_z) - yaw;
    const double speed = synth_draw_range(d, 0.5, 1.2);
    const double begin = synth_draw_range(d, 0.5, 1.6), stop = begin + length / speed;
    const double heading = nearest_turn(SYNTH_WEST, facing + synth_draw_range(d, -0.9, 0.9));
    const double stay = stop + 0.6 + synth_draw_range(d, 1.5, 3.5);
    const double back = nearest_turn(heading, SYNTH_EAST);
    person->T_level_path.p = rlf_vec3_make(lane->to_x, 0.0, lane->to_z);
    person->T_level_path.q = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), yaw);
    person->acts[0] = (synth_act){true, begin, stop, length, 0.0};
    person->acts[1] = (synth_act){false, stop, stop + 0.6, SYNTH_WEST, heading};
    person->acts[2] = (synth_act){false, stay, stay + 0.7, heading, back};
    person->acts[3] = (synth_act){true, stay + 0.7, stay + 0.7 + length / speed, 0.0, length};
    person->script =
        (synth_script){.period = 1e6, .heading = SYNTH_WEST, .act_count = SYNTH_ACTS_MAX};
    if (synth_draw_chance(d, 0.6)) {
        person->script.reach_begin = stop + 0.3;
        person->script.reach_end = stay + 0.2;
    }
}

/* Seat of a stool behind who has stopped; false where it has no room. */
static bool add_stool(synth_plan *plan, synth_individual *person, const synth_lane *lane)
{
    const double leg = person->figure.leg, radius = 0.17 * leg + 0.02, height = 0.42 * leg;
    const rlf_vec3 ahead = {rlf_sin(person->acts[1].to), 0, rlf_cos(person->acts[1].to)};
    const rlf_vec3 level = rlf_rotate(person->T_level_path.q, ahead);
    const double x = lane->to_x - STOOL_BACK * leg * level.x;
    const double z = lane->to_z - STOOL_BACK * leg * level.z;
    const double half = radius + 0.02;
    const synth_plot plot = {x - half, x + half, z - half, z + half};
    const synth_flesh *last = &person->flesh[person->flesh_count - 1];
    bool is_skirted = false; /* coats and skirts are stiff: who wears one stands */
    for (const synth_flesh *f = person->flesh; f <= last; f++) {
        is_skirted = is_skirted || (f->bone == SYNTH_PELVIS && f->type == SYNTH_FRUSTUM);
    }
    if (is_skirted || synth_place_from_lane(lane, x, z) < STOOL_BACK * leg - 0.06 ||
        !synth_place_is_free(plan, plot)) {
        return false;
    }
    synth_place_take(plan, plot);
    synth_maker m = synth_make(plan, (synth_spot){x, z, 0.0});
    synth_make_round(&m, &plan->wood, rlf_vec3_make(0, 0, 0), 0.9 * radius, 0.55 * radius, 0.03);
    synth_make_round(&m, &plan->metal, rlf_vec3_make(0, 0.03, 0), 0.04, 0.04, height - 0.07);
    synth_make_round(&m, &plan->cloth, rlf_vec3_make(0, height - 0.04, 0), radius, radius, 0.04);
    person->script.sit_begin = person->acts[1].end;
    person->script.sit_end = person->acts[2].begin;
    person->script.seat = height + 0.11 * leg;
    return true;
}

/* All of it smaller, the head less so: a child. */
static void make_child(synth_figure *f, double scale)
{
    const double head = 0.45 + 0.55 * scale;
    f->trunk *= scale;
    f->leg *= scale;
    f->arm *= scale;
    f->shoulder *= scale;
    f->hip *= scale;
    f->shoulder_height *= scale;
    f->clear *= scale;
    f->step *= scale;
    for (int32_t i = 0; i < SYNTH_PERSON_FLESH; i++) {
        synth_flesh *part = &f->flesh[i];
        const double by = part->bone == SYNTH_HEAD ? head : scale;
        part->offset = rlf_scale(part->offset, by);
        part->size = rlf_scale(part->size, by);
        part->length *= by;
        part->radius_a *= by;
        part->radius_b *= by;
    }
    f->flesh[5].name = "child's head";
}

static void draw_individual(synth_plan *plan, synth_individual *person, uint64_t seed, int32_t i)
{
    synth_draw *d = &plan->draw;
    *person = (synth_individual){.label = i == 0 ? RLF_SYNTHETIC_LABEL_PERSON
                                                 : RLF_SYNTHETIC_LABEL_SECOND_PERSON + i - 1};
    synth_figure_make(&person->figure, 16 * seed + (uint64_t)i + 2, false);
    person->figure.pace = 1.0;
    if (synth_draw_chance(d, 0.25)) {
        make_child(&person->figure, synth_draw_range(d, 0.58, 0.82));
    }
}

void synth_draw_people(synth_plan *plan, uint64_t seed)
{
    synth_draw *d = &plan->draw;
    synth_random *r = plan->random;
    static const int32_t counts[8] = {1, 1, 1, 2, 2, 2, 3, 4};
    const int32_t count = counts[synth_draw_index(d, 8)];
    for (int32_t i = 0; i < count; i++) {
        synth_individual *person = &r->people[r->people_count];
        synth_lane lane;
        draw_individual(plan, person, seed, i);
        if (!draw_lane(plan, 1.7 * person->figure.leg, &lane)) {
            continue;
        }
        draw_script(person, d, &lane);
        synth_draw_clothes(person, d);
        if (synth_draw_chance(d, 0.3)) {
            (void)add_stool(plan, person, &lane);
        }
        plan->lanes[plan->lane_count++] = lane;
        r->people_count++;
    }
}
