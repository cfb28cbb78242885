/* The Open Dynamics Engine: QuickStep with its default settings, sleep on. */
#include "peer.h"

#include <ode/ode.h>
#include <stdlib.h>
#include <string.h>

#define CONTACTS 8

typedef struct layer {
    dTriMeshDataID data;
    dGeomID geom;
    float *vertices;
    uint32_t *triangles;
} layer;

typedef struct engine {
    dWorldID world;
    dSpaceID space;
    dJointGroupID contacts;
    dBodyID *bodies;
    layer layers[2];
    int32_t count;
    double friction, restitution;
} engine;

static void *open_engine(rlf_vec3 gravity, int32_t capacity)
{
    engine *e = calloc(1, sizeof(*e));
    if (e == NULL) {
        return NULL;
    }
    dInitODE2(0);
    e->bodies = calloc((size_t)capacity, sizeof(*e->bodies));
    e->world = dWorldCreate();
    e->space = dHashSpaceCreate(NULL);
    e->contacts = dJointGroupCreate(0);
    dWorldSetGravity(e->world, gravity.x, gravity.y, gravity.z);
    dWorldSetAutoDisableFlag(e->world, 1);
    return e;
}

static void drop_layer(layer *l)
{
    if (l->geom != NULL) {
        dGeomDestroy(l->geom);
        dGeomTriMeshDataDestroy(l->data);
    }
    free(l->vertices);
    free(l->triangles);
    memset(l, 0, sizeof(*l));
}

static void close_engine(void *context)
{
    engine *e = context;
    drop_layer(&e->layers[0]);
    drop_layer(&e->layers[1]);
    dJointGroupDestroy(e->contacts);
    dSpaceDestroy(e->space);
    dWorldDestroy(e->world);
    free(e->bodies);
    free(e);
    dCloseODE();
}

static bool add(void *context, const peer_body *b)
{
    engine *e = context;
    dGeomID geom = b->radius > 0.0
                       ? dCreateSphere(e->space, b->radius)
                       : dCreateBox(e->space, 2 * b->half.x, 2 * b->half.y, 2 * b->half.z);
    e->friction = b->friction;
    e->restitution = b->restitution;
    const dQuaternion q = {b->pose.q.w, b->pose.q.x, b->pose.q.y, b->pose.q.z};
    if (b->mass == 0.0) {
        dGeomSetPosition(geom, b->pose.p.x, b->pose.p.y, b->pose.p.z);
        e->count++;
        return true;
    }
    dMass mass;
    dBodyID body = dBodyCreate(e->world);
    if (b->radius > 0.0) {
        dMassSetSphereTotal(&mass, b->mass, b->radius);
    } else {
        dMassSetBoxTotal(&mass, b->mass, 2 * b->half.x, 2 * b->half.y, 2 * b->half.z);
    }
    dBodySetMass(body, &mass);
    dGeomSetBody(geom, body);
    dBodySetPosition(body, b->pose.p.x, b->pose.p.y, b->pose.p.z);
    dBodySetQuaternion(body, q);
    dBodySetLinearVel(body, b->v.x, b->v.y, b->v.z);
    dBodySetAngularVel(body, b->w.x, b->w.y, b->w.z);
    e->bodies[e->count++] = body;
    return true;
}

static bool set_mesh(void *context, int32_t index, const peer_mesh *mesh)
{
    layer *l = &((engine *)context)->layers[index];
    drop_layer(l);
    size_t vertices = 3 * (size_t)mesh->vertex_count * sizeof(float);
    size_t triangles = 3 * (size_t)mesh->triangle_count * sizeof(uint32_t);
    if (mesh->triangle_count == 0) {
        return true;
    }
    l->vertices = malloc(vertices);
    l->triangles = malloc(triangles);
    if (l->vertices == NULL || l->triangles == NULL) {
        return false;
    }
    memcpy(l->vertices, mesh->vertices, vertices);
    memcpy(l->triangles, mesh->triangles, triangles);
    l->data = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSingle(l->data, l->vertices, 3 * sizeof(float), mesh->vertex_count,
                                l->triangles, 3 * mesh->triangle_count, 3 * sizeof(uint32_t));
    l->geom = dCreateTriMesh(((engine *)context)->space, l->data, NULL, NULL, NULL);
    return true;
}

static void touch(void *context, dGeomID a, dGeomID b)
{
    engine *e = context;
    dContact contacts[CONTACTS];
    memset(contacts, 0, sizeof(contacts));
    if (dGeomGetBody(a) == NULL && dGeomGetBody(b) == NULL) {
        return;
    }
    int count = dCollide(a, b, CONTACTS, &contacts[0].geom, sizeof(dContact));
    for (int i = 0; i < count; i++) {
        contacts[i].surface.mode = dContactBounce | dContactApprox1;
        contacts[i].surface.mu = e->friction;
        contacts[i].surface.bounce = e->restitution;
        contacts[i].surface.bounce_vel = 0.1;
        dJointAttach(dJointCreateContact(e->world, e->contacts, &contacts[i]), dGeomGetBody(a),
                     dGeomGetBody(b));
    }
}

static void step(void *context, double dt, const rlf_grid *grid)
{
    engine *e = context;
    (void)grid;
    dSpaceCollide(e->space, e, touch);
    dWorldQuickStep(e->world, dt);
    dJointGroupEmpty(e->contacts);
}

static rlf_vec3 vec(const dReal *v)
{
    return rlf_vec3_make(v[0], v[1], v[2]);
}

static peer_state state(const void *context, int32_t index)
{
    const engine *e = context;
    peer_state s = {.pose = rlf_pose_identity()};
    dBodyID body = e->bodies[index];
    if (body != NULL) {
        const dReal *q = dBodyGetQuaternion(body);
        s.pose.p = vec(dBodyGetPosition(body));
        s.pose.q = (rlf_quat){q[1], q[2], q[3], q[0]};
        s.v = vec(dBodyGetLinearVel(body));
        s.w = vec(dBodyGetAngularVel(body));
    }
    return s;
}

const peer peer_ode = {"ODE", true, open_engine, close_engine, add, set_mesh, step, state};
