// Bullet: sequential impulses with its default settings, sleep on.
#include "peer.h"

#include <btBulletDynamicsCommon.h>
#include <cmath>
#include <memory>
#include <vector>

namespace {

struct layer {
    std::vector<float> vertices;
    std::vector<int> triangles;
    std::unique_ptr<btTriangleIndexVertexArray> mesh;
    std::unique_ptr<btBvhTriangleMeshShape> shape;
    std::unique_ptr<btCollisionObject> object;
};

struct engine {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broad;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world{&dispatcher, &broad, &solver, &configuration};
    std::vector<std::unique_ptr<btCollisionShape>> shapes;
    std::vector<std::unique_ptr<btRigidBody>> bodies;
    layer layers[2];
};

btVector3 to_bullet(rlf_vec3 v)
{
    return btVector3(btScalar(v.x), btScalar(v.y), btScalar(v.z));
}

rlf_vec3 from_bullet(const btVector3 &v)
{
    return rlf_vec3_make(double(v.x()), double(v.y()), double(v.z()));
}

void *open_engine(rlf_vec3 gravity, int32_t)
{
    engine *e = new engine;
    e->world.setGravity(to_bullet(gravity));
    return e;
}

void drop_layer(engine *e, layer *l)
{
    if (l->object) {
        e->world.removeCollisionObject(l->object.get());
        l->object.reset();
    }
}

void close_engine(void *context)
{
    engine *e = static_cast<engine *>(context);
    for (layer &l : e->layers) {
        drop_layer(e, &l);
    }
    for (auto &body : e->bodies) {
        e->world.removeRigidBody(body.get());
    }
    delete e;
}

// Bullet multiplies the two surfaces' figures.
void set_surface(btCollisionObject *object, double friction, double restitution)
{
    object->setFriction(btScalar(std::sqrt(friction)));
    object->setRestitution(btScalar(std::sqrt(restitution)));
}

bool add(void *context, const peer_body *b)
{
    engine *e = static_cast<engine *>(context);
    btCollisionShape *shape =
        b->radius > 0.0 ? static_cast<btCollisionShape *>(new btSphereShape(btScalar(b->radius)))
                        : new btBoxShape(to_bullet(b->half));
    e->shapes.emplace_back(shape);
    btVector3 inertia(0, 0, 0);
    if (b->mass > 0.0) {
        shape->calculateLocalInertia(btScalar(b->mass), inertia);
    }
    btRigidBody *body = new btRigidBody(btScalar(b->mass), nullptr, shape, inertia);
    const rlf_quat q = b->pose.q;
    body->setWorldTransform(
        btTransform(btQuaternion(btScalar(q.x), btScalar(q.y), btScalar(q.z), btScalar(q.w)),
                    to_bullet(b->pose.p)));
    body->setLinearVelocity(to_bullet(b->v));
    body->setAngularVelocity(to_bullet(b->w));
    set_surface(body, b->friction, b->restitution);
    e->bodies.emplace_back(body);
    e->world.addRigidBody(body);
    return true;
}

bool set_mesh(void *context, int32_t index, const peer_mesh *mesh)
{
    engine *e = static_cast<engine *>(context);
    layer *l = &e->layers[index];
    drop_layer(e, l);
    if (mesh->triangle_count == 0) {
        return true;
    }
    l->vertices.assign(mesh->vertices, mesh->vertices + 3 * mesh->vertex_count);
    l->triangles.assign(mesh->triangles, mesh->triangles + 3 * mesh->triangle_count);
    l->mesh = std::make_unique<btTriangleIndexVertexArray>(
        mesh->triangle_count, l->triangles.data(), 3 * int(sizeof(int)), mesh->vertex_count,
        l->vertices.data(), 3 * int(sizeof(float)));
    l->shape = std::make_unique<btBvhTriangleMeshShape>(l->mesh.get(), true);
    l->object = std::make_unique<btCollisionObject>();
    l->object->setCollisionShape(l->shape.get());
    set_surface(l->object.get(), 0.5, 0.5);
    e->world.addCollisionObject(l->object.get());
    return true;
}

void step(void *context, double dt, const rlf_grid *)
{
    static_cast<engine *>(context)->world.stepSimulation(btScalar(dt), 0);
}

peer_state state(const void *context, int32_t index)
{
    const btRigidBody *body = static_cast<const engine *>(context)->bodies[size_t(index)].get();
    const btTransform &t = body->getWorldTransform();
    const btQuaternion q = t.getRotation();
    peer_state s;
    s.pose.p = from_bullet(t.getOrigin());
    s.pose.q = rlf_quat{double(q.x()), double(q.y()), double(q.z()), double(q.w())};
    s.v = from_bullet(body->getLinearVelocity());
    s.w = from_bullet(body->getAngularVelocity());
    s.is_gone = false;
    return s;
}

} // namespace

extern "C" const peer peer_bullet = {"Bullet", true,     open_engine, close_engine, add,
                                     set_mesh, step, state};
