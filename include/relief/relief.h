/* Relief: everything of the core library (librelief). Files and devices are in relief/io.h
 * (librelief_io), OpenGL in relief/gl.h (librelief_gl), the window in relief/window.h
 * (librelief_window), the simulator in relief/synthetic.h (librelief_sim); who writes a camera's
 * driver needs relief/backend.h alone. What is in which header, in the order of the data:
 *
 *   base.h         results, the error line, log, memory, clock, worker pool: all others need it
 *   math.h         vectors, quaternions, poses, boxes
 *   image.h        views of picture planes
 *   camera.h       lenses and the registration of one camera's picture to another's
 *   frame.h        a depth picture with its colour, and the rig that took it
 *   source.h       where frames come from; playback.h: what comes after a recording's end
 *   surface.h      the real surface of a frame; reconstruct.h: the stage that makes it
 *   snapshot.h     shapes, bodies, contacts; world.h: the physics stage; query.h: rays and overlaps
 *   model.h        what bodies look like; known.h: models of real things
 *   compositor.h   the render stage
 *   hands.h        hands in the surface's foreground, their gestures and events
 *   prediction.h   what a camera would see of the static room from a pose
 *   map.h          that room: views fused into a signed distance volume, predictions, mesh
 *   track.h        a moving camera's pose, frame by frame
 *   pipeline.h     all stages as one object: where most programs begin
 *
 * Conventions, unless a comment says otherwise: metres, seconds, kilograms, radians; the camera's
 * frame is x right, y down, z forward; planes are row-major from the top. A def comes from its
 * _default function. A _create gives an object that its _destroy frees; NULL may be destroyed.
 * Objects share nothing, so each may be used from any one thread at a time.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_RELIEF_H
#define RELIEF_RELIEF_H

#include "relief/base.h"
#include "relief/camera.h"
#include "relief/compositor.h"
#include "relief/frame.h"
#include "relief/hands.h"
#include "relief/image.h"
#include "relief/known.h"
#include "relief/map.h"
#include "relief/math.h"
#include "relief/model.h"
#include "relief/pipeline.h"
#include "relief/playback.h"
#include "relief/prediction.h"
#include "relief/query.h"
#include "relief/reconstruct.h"
#include "relief/snapshot.h"
#include "relief/source.h"
#include "relief/surface.h"
#include "relief/track.h"
#include "relief/world.h"

#endif
