/* Your own physics engine moves the bodies, here the Open Dynamics Engine (Debian: libode-dev).
 * Relief knows the real world, and tells ODE where a body touches it.
 *
 * A crate falls into the simulated room. A Relief world holds a twin of the crate: each substep the
 * twin goes where ODE has the crate, and its contacts become contact joints of ODE. */
#include "relief/io.h"

#include <ode/ode.h>
#include <stdio.h>

#define SUBSTEPS 8
#define SIDE_M 0.2
#define SKIN_M 0.002 /* contacts from this near on */

typedef struct twins {
    dWorldID engine;
    dBodyID body;
    dJointGroupID joints;
    rlf_world *world;
    rlf_body_id id;
    int64_t contacts;
} twins;

static rlf_vec3 vec3(const dReal *v)
{
    return rlf_vec3_make(v[0], v[1], v[2]);
}

/* A contact joint for every place where the twin meets the real world. */
static void touch(twins *t)
{
    const rlf_snapshot *s = rlf_world_get_snapshot(t->world);
    for (int32_t i = 0; i < s->contact_count; i++) {
        const rlf_contact *c = &s->contacts[i];
        if (c->separation > SKIN_M) {
            continue;
        }
        dContact contact = {.surface = {.mode = dContactBounce | dContactApprox1, .mu = 0.5}};
        contact.surface.bounce = 0.3;
        contact.surface.bounce_vel = 0.2;
        contact.geom = (dContactGeom){.pos = {c->point.x, c->point.y, c->point.z},
                                      .normal = {c->normal.x, c->normal.y, c->normal.z},
                                      .depth = c->separation < 0.0 ? -c->separation : 0.0};
        dJointAttach(dJointCreateContact(t->engine, t->joints, &contact), t->body, NULL);
        t->contacts++;
    }
}

static void substep(twins *t, const rlf_grid *grid, double dt)
{
    const dReal *q = dBodyGetQuaternion(t->body); /* w, x, y, z */
    const rlf_pose pose = {.q = {.w = q[0], .x = q[1], .y = q[2], .z = q[3]},
                           .p = vec3(dBodyGetPosition(t->body))};
    rlf_world_set_body(t->world, t->id, &pose, vec3(dBodyGetLinearVel(t->body)),
                       vec3(dBodyGetAngularVel(t->body)));
    rlf_world_advance(t->world, grid, dt);
    touch(t);
    dWorldStep(t->engine, dt);
    dJointGroupEmpty(t->joints);
}

/* Frames of the room through the surface stage, and the engine in step with them. */
static rlf_result run(twins *t, rlf_pipeline *pipeline)
{
    rlf_pipeline_output frame;
    int64_t before_ns = 0;
    for (int i = 0; i < 80; i++) { /* then the visitor kicks it */
        const rlf_result result = rlf_pipeline_step(pipeline, &frame);
        if (result != RLF_OK) {
            return result;
        }
        rlf_grid grid;
        rlf_grid_from_surface(frame.surface, &frame.T_world_camera, NULL, 0, &grid);
        const double dt = 1e-9 * (double)(frame.frame.time_ns - before_ns) / SUBSTEPS;
        for (int k = 0; k < SUBSTEPS && i > 0; k++) {
            substep(t, &grid, dt);
        }
        before_ns = frame.frame.time_ns;
    }
    return RLF_OK;
}

static rlf_result make_twins(twins *t, rlf_vec3 gravity)
{
    dMass mass;
    t->engine = dWorldCreate();
    t->joints = dJointGroupCreate(0);
    t->body = dBodyCreate(t->engine);
    dWorldSetGravity(t->engine, gravity.x, gravity.y, gravity.z);
    dMassSetBoxTotal(&mass, 1.0, SIDE_M, SIDE_M, SIDE_M);
    dBodySetMass(t->body, &mass);
    dBodySetPosition(t->body, 0.7, -0.2, 2.4);

    const rlf_world_def def = rlf_world_def_default();
    rlf_body_def crate = rlf_body_def_default();
    crate.shape = (rlf_shape){.type = RLF_SHAPE_BOX, .size = {SIDE_M, SIDE_M, SIDE_M}};
    crate.gravity_scale = 0.0; /* ODE has it */
    const rlf_result result = rlf_world_create(&def, &t->world);
    return result == RLF_OK ? rlf_world_add_body(t->world, &crate, &t->id) : result;
}

int main(void)
{
    rlf_source *source = NULL;
    rlf_pipeline *pipeline = NULL;
    twins t = {0};
    dInitODE2(0);
    rlf_result result = rlf_open_source("synthetic:room", NULL, &source);
    if (result == RLF_OK) {
        const rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
        result = rlf_pipeline_create(&def, &pipeline);
    }
    result = result == RLF_OK ? make_twins(&t, rlf_vec3_make(0, 9.81, 0)) : result;
    result = result == RLF_OK ? run(&t, pipeline) : result;
    bool rests = false;
    if (result == RLF_OK) {
        const rlf_vec3 p = vec3(dBodyGetPosition(t.body));
        const double speed = rlf_length(vec3(dBodyGetLinearVel(t.body)));
        rests = speed < 0.05 && t.contacts > 0;
        printf("ODE's crate is at (%.2f, %.2f, %.2f) m, %.3f m/s fast: it %s\n", p.x, p.y, p.z,
               speed, rests ? "rests" : "does not rest");
    } else {
        fprintf(stderr, "%s\n", rlf_error_text());
    }
    dWorldDestroy(t.engine);
    dCloseODE();
    rlf_world_destroy(&t.world);
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
    return rests ? 0 : 1;
}
