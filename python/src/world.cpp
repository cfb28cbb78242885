// Worlds, bodies and what they touch.
#include "bind.hpp"

#include <cmath>
#include <cstring>

namespace
{

struct WorldOwner : Owner {
    rlf_pool *pool = nullptr;
    rlf_world *world = nullptr;

    WorldOwner() : Owner("world") {}
    ~WorldOwner() override
    {
        const Unlocked unlocked;
        rlf_world_destroy(&world);
        rlf_pool_destroy(&pool);
    }
};

const char *const shapes[] = {"box", "sphere", "capsule", "cylinder", "hull", nullptr};
const char *const others[] = {"body", "background", "foreground", nullptr};

struct World {
    std::shared_ptr<Owner> owner;
    rlf_world *world;
    bool is_own; // not a pipeline's

    rlf_world *open() const
    {
        owner->need_open();
        return world;
    }
};

struct Body {
    std::shared_ptr<Owner> owner;
    rlf_world *world;
    rlf_body_id id;

    rlf_body_state state() const
    {
        owner->need_open();
        const rlf_snapshot *now = rlf_world_get_snapshot(world);
        for (int32_t i = 0; i < now->body_count; i++) {
            const rlf_body_id &other = now->bodies[i].id;
            if (other.index1 == id.index1 && other.generation == id.generation) {
                return now->bodies[i];
            }
        }
        throw py::value_error("this body is gone, or is not of this world");
    }
};

rlf_body_def def_from(const std::string &shape, const py::object &size, double radius,
                      double height, const py::kwargs &more)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape = shape_from(shape, size, radius, height);
    for (const auto &item : more) {
        const auto key = item.first.cast<std::string>();
        const auto value = py::reinterpret_borrow<py::object>(item.second);
        if (key == "name") {
            if (!py::isinstance<py::str>(value)) {
                throw py::type_error("name: use a str");
            }
            name_from(value.cast<std::string>(), def.name);
        } else if (key == "position") {
            def.position = vector_from(value, "position");
        } else if (key == "pose") {
            const rlf_pose pose = pose_from(value, "pose");
            def.position = pose.p;
            def.orientation = pose.q;
        } else if (key == "velocity") {
            def.velocity = vector_from(value, "velocity");
        } else if (key == "angular_velocity") {
            def.angular_velocity = vector_from(value, "angular_velocity");
        } else if (key == "color") {
            const rlf_vec3 c = vector_from(value, "color");
            def.color[0] = static_cast<float>(c.x);
            def.color[1] = static_cast<float>(c.y);
            def.color[2] = static_cast<float>(c.z);
        } else if (key == "mass") {
            def.mass = number_from(value, "mass");
        } else if (key == "restitution") {
            def.restitution = number_from(value, "restitution");
        } else if (key == "friction") {
            def.friction = number_from(value, "friction");
        } else if (key == "is_kinematic") {
            def.is_kinematic = PyObject_IsTrue(value.ptr()) == 1;
        } else if (key == "collides_with_bodies") {
            def.collides_with_bodies = PyObject_IsTrue(value.ptr()) == 1;
        } else {
            throw py::type_error(
                "add(): there is no \"" + key +
                "\": use name, position, pose, velocity, angular_velocity, mass, "
                "restitution, friction, color, is_kinematic or collides_with_bodies");
        }
    }
    return def;
}

Body add(World &w, const std::string &shape, const py::object &size, double radius, double height,
         const py::kwargs &more)
{
    rlf_world *world = w.open();
    const Busy busy(*w.owner);
    const rlf_body_def def = def_from(shape, size, radius, height, more);
    rlf_body_id id;
    check(rlf_world_add_body(world, &def, &id));
    return {w.owner, world, id};
}

World make_world(const py::object &gravity, int threads)
{
    auto owner = std::make_shared<WorldOwner>();
    owner->pool = make_pool(threads);
    rlf_world_def def = rlf_world_def_default();
    def.gravity = gravity.is_none() ? def.gravity : vector_from(gravity, "gravity");
    def.pool = owner->pool;
    check(rlf_world_create(&def, &owner->world));
    return {owner, owner->world, true};
}

void advance(World &w, double dt, const py::object &surface, const py::object &camera_pose)
{
    rlf_world *world = w.open();
    if (!w.is_own) {
        throw py::value_error("this world is a pipeline's: its steps advance it");
    }
    if (!(dt > 0.0 && dt <= 1.0)) {
        throw py::value_error("dt: use more than 0 and at most 1 second");
    }
    const Busy busy(*w.owner);
    rlf_grid grid;
    std::shared_ptr<Owner> other; // the pipeline that the surface is of
    const rlf_surface *seen = surface.is_none() ? nullptr : surface_in(surface, &other);
    std::unique_ptr<Busy> other_busy;
    if (seen != nullptr) {
        other_busy = std::make_unique<Busy>(*other);
        const rlf_pose T =
            camera_pose.is_none() ? rlf_pose_identity() : pose_from(camera_pose, "camera_pose");
        rlf_grid_from_surface(seen, &T, nullptr, 0, &grid);
    }
    const Unlocked unlocked;
    rlf_world_advance(world, seen != nullptr ? &grid : nullptr, dt);
}

void set_body(Body &b, const py::object &pose, const py::object &velocity, const py::object &spin)
{
    const Busy busy(*b.owner);
    const rlf_body_state now = b.state();
    const rlf_pose to = pose.is_none() ? now.T_world_body : pose_from(pose, "pose");
    const rlf_vec3 v = velocity.is_none() ? now.velocity : vector_from(velocity, "velocity");
    const rlf_vec3 w =
        spin.is_none() ? now.angular_velocity : vector_from(spin, "angular_velocity");
    if (!rlf_world_set_body(b.world, b.id, &to, v, w)) {
        throw py::value_error("this body is gone");
    }
}

void apply_impulse(Body &b, const py::object &impulse, const py::object &point)
{
    const Busy busy(*b.owner);
    const rlf_body_state now = b.state();
    const rlf_vec3 at = point.is_none() ? now.T_world_body.p : vector_from(point, "point");
    rlf_world_apply_impulse(b.world, b.id, vector_from(impulse, "impulse"), at);
}

void remove_body(Body &b)
{
    b.owner->need_open();
    const Busy busy(*b.owner);
    rlf_world_remove_body(b.world, b.id);
}

struct BodyState {
    rlf_body_state s;
};

template <typename Get> auto of_body(Get get)
{
    return [get](const Body &b) {
        const Busy busy(*b.owner);
        return get(b.state());
    };
}

template <typename Get> auto of_state(Get get)
{
    return [get](const BodyState &b) { return get(b.s); };
}

template <typename Class, typename Of> void bind_readings(Class &c, Of of)
{
    using S = const rlf_body_state &;
    c.def_property_readonly("name", of([](S s) { return std::string(s.name); }),
                            "As it was added, or \"body-N\".")
        .def_property_readonly("shape", of([](S s) { return shapes[s.shape.type]; }),
                               "\"box\", \"sphere\", \"capsule\", \"cylinder\" or \"hull\".")
        .def_property_readonly("pose", of([](S s) { return matrix_of(s.T_world_body); }),
                               "(4, 4): body in the world.")
        .def_property_readonly("position", of([](S s) { return array_of(s.T_world_body.p); }),
                               "Centre of mass, world, metres.")
        .def_property_readonly("velocity", of([](S s) { return array_of(s.velocity); }), "m/s.")
        .def_property_readonly("angular_velocity",
                               of([](S s) { return array_of(s.angular_velocity); }),
                               "rad/s, world.")
        .def_property_readonly("mass", of([](S s) { return s.mass; }), "kg.")
        .def_property_readonly("is_asleep", of([](S s) { return s.is_asleep; }),
                               "At rest until something touches it.")
        .def_property_readonly("is_held", of([](S s) { return s.is_held; }),
                               "Waits for the release time that its scene gives it.")
        .def_property_readonly("is_grabbed", of([](S s) { return s.is_grabbed; }),
                               "Real fingers or hands hold it.");
}

void bind_bodies(py::module_ &m)
{
    py::class_<Body> body(m, "Body",
                          "A body of a world, as it is now: it belongs to that world alone.");
    bind_readings(body, [](auto get) { return of_body(get); });
    body.def("set", &set_body, py::arg("pose") = py::none(), py::arg("velocity") = py::none(),
             py::arg("angular_velocity") = py::none(), "Moves it, or changes its velocities.")
        .def("apply_impulse", &apply_impulse, py::arg("impulse"), py::arg("point") = py::none(),
             "N s at a world point; None = the centre of mass.")
        .def("remove", &remove_body, "Takes it out of its world.")
        .def_property_readonly(
            "is_alive",
            [](const Body &b) {
                const Busy busy(*b.owner);
                return !b.owner->is_closed && rlf_world_has_body(b.world, b.id);
            },
            "False once it is removed, or its world is closed.")
        .def("__eq__",
             [](const Body &a, const py::object &other) {
                 if (!py::isinstance<Body>(other)) {
                     return false;
                 }
                 const Body &b = other.cast<const Body &>();
                 return a.world == b.world && a.id.index1 == b.id.index1 &&
                        a.id.generation == b.id.generation;
             })
        .def("__hash__",
             [](const Body &b) { return py::hash(py::make_tuple(b.id.index1, b.id.generation)); });
    py::class_<BodyState> state(m, "BodyState", "A body as a step left it: a copy.");
    bind_readings(state, [](auto get) { return of_state(get); });
}

struct Contact {
    rlf_contact c;
    std::string body;
};

std::string name_in(const rlf_snapshot *s, rlf_body_id id)
{
    for (int32_t i = 0; i < s->body_count; i++) {
        if (s->bodies[i].id.index1 == id.index1 && s->bodies[i].id.generation == id.generation) {
            return s->bodies[i].name;
        }
    }
    return "";
}

void bind_contacts(py::module_ &m)
{
    using C = const Contact &;
    py::class_<Contact>(m, "Contact", "A point at which a body met something; world frame.")
        .def_readonly("body", &Contact::body, "The body's name.")
        .def_property_readonly(
            "other", [](C c) { return others[c.c.other]; },
            "\"body\", \"background\" (the room) or \"foreground\" (people).")
        .def_property_readonly(
            "point", [](C c) { return array_of(c.c.point); }, "Metres.")
        .def_property_readonly(
            "normal", [](C c) { return array_of(c.c.normal); }, "Unit, to the body.")
        .def_property_readonly(
            "impulse", [](C c) { return c.c.impulse; }, "N s.")
        .def_property_readonly(
            "separation", [](C c) { return c.c.separation; }, "Metres.")
        .def_property_readonly(
            "approach_speed", [](C c) { return c.c.approach_speed; },
            "m/s at which they met; 0 of what rests.")
        .def_property_readonly(
            "label", [](C c) { return c.c.region_label; },
            "Region.label of the surface; 0 = none.");
}

py::object cast_ray(World &w, const py::object &origin, const py::object &direction, double length)
{
    rlf_world *world = w.open();
    const Busy busy(*w.owner);
    const rlf_ray_hit hit = rlf_world_cast_ray(world, nullptr, vector_from(origin, "origin"),
                                               vector_from(direction, "direction"), length);
    if (hit.reason == RLF_QUERY_INVALID) {
        throw py::value_error("cast_ray: use a direction that is not 0 and a length > 0");
    }
    if (hit.reason != RLF_QUERY_HIT) {
        return py::none();
    }
    return py::make_tuple(Body{w.owner, world, hit.body}, hit.distance, array_of(hit.point),
                          array_of(hit.normal));
}

void set_gravity(World &w, const py::object &gravity)
{
    rlf_world *world = w.open();
    const Busy busy(*w.owner);
    rlf_world_set_gravity(world, vector_from(gravity, "gravity"));
}

} // namespace

rlf_shape shape_from(const std::string &shape, const py::object &size, double radius, double height)
{
    rlf_shape out = rlf_body_def_default().shape;
    out.type = static_cast<rlf_shape_type>(choice_from(shape, shapes, "shape"));
    if (out.type == RLF_SHAPE_HULL) {
        throw py::value_error("shape: hulls come from scene files");
    }
    out.size = size.is_none() ? out.size : vector_from(size, "size");
    out.radius = radius;
    out.height = height;
    return out;
}

const char *shape_name(rlf_shape_type type)
{
    return shapes[type];
}

void name_from(const std::string &name, char out[RLF_NAME_MAX])
{
    if (name.size() >= RLF_NAME_MAX || name.find('\0') != std::string::npos) {
        throw py::value_error("name: use at most 63 bytes, none of them zero");
    }
    std::strcpy(out, name.c_str());
}

py::object body_of(const std::shared_ptr<Owner> &owner, rlf_world *world, rlf_body_id id)
{
    return py::cast(Body{owner, world, id});
}

py::object world_of(const std::shared_ptr<Owner> &owner, rlf_world *world)
{
    return py::cast(World{owner, world, false});
}

py::list bodies_of(const rlf_snapshot *snapshot)
{
    py::list out;
    for (int32_t i = 0; i < snapshot->body_count; i++) {
        out.append(py::cast(BodyState{snapshot->bodies[i]}));
    }
    return out;
}

py::list contacts_of(const rlf_snapshot *snapshot)
{
    py::list out;
    for (int32_t i = 0; i < snapshot->contact_count; i++) {
        const rlf_contact &c = snapshot->contacts[i];
        out.append(py::cast(Contact{c, name_in(snapshot, c.body)}));
    }
    return out;
}

py::list events_of(const rlf_snapshot *snapshot)
{
    py::list out;
    for (int32_t i = 0; i < snapshot->event_count; i++) {
        const rlf_contact_event &e = snapshot->events[i];
        out.append(py::make_tuple(e.is_begin ? "begin" : "end", name_in(snapshot, e.body),
                                  others[e.other]));
    }
    return out;
}

void bind_world(py::module_ &m)
{
    bind_bodies(m);
    bind_contacts(m);
    py::class_<World>(m, "World", "Bodies and the solver; metres, seconds, kilograms.")
        .def(py::init(&make_world), py::arg("gravity") = py::none(), py::arg("threads") = 1)
        .def("add", &add, py::arg("shape") = "box", py::arg("size") = py::none(),
             py::arg("radius") = 0.05, py::arg("height") = 0.1,
             "Adds a body: shape \"box\" (size), \"sphere\" (radius), \"capsule\" or \"cylinder\" "
             "(radius, height along y). More by name: name, position, pose, velocity, "
             "angular_velocity, mass, restitution, friction, color, is_kinematic, "
             "collides_with_bodies.")
        .def("advance", &advance, py::arg("dt"), py::arg("surface") = py::none(),
             py::arg("camera_pose") = py::none(),
             "By dt seconds, at most 1, against a Surface seen from camera_pose, or through empty "
             "space. A "
             "pipeline's world is advanced by its steps.")
        .def("cast_ray", &cast_ray, py::arg("origin"), py::arg("direction"), py::arg("length"),
             "(body, distance, point, normal) of the first body on the ray, or None.")
        .def("set_gravity", &set_gravity, py::arg("gravity"), "m/s^2.")
        .def_property_readonly(
            "bodies",
            [](const World &w) {
                rlf_world *world = w.open();
                const Busy busy(*w.owner);
                const rlf_snapshot *now = rlf_world_get_snapshot(world);
                py::list out;
                for (int32_t i = 0; i < now->body_count; i++) {
                    out.append(Body{w.owner, world, now->bodies[i].id});
                }
                return out;
            },
            "Body of each, in the order in which they were added.")
        .def_property_readonly(
            "contacts",
            [](const World &w) {
                const rlf_world *world = w.open();
                const Busy busy(*w.owner);
                return contacts_of(rlf_world_get_snapshot(world));
            },
            "Contact of each point of the last advance, copied.")
        .def_property_readonly(
            "time",
            [](const World &w) {
                return static_cast<double>(rlf_world_get_snapshot(w.open())->time_ns) * 1e-9;
            },
            "Seconds that it was advanced by.");
}
