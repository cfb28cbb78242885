/* Relief: everything of the core library (librelief). Files and devices are in relief/io.h, OpenGL
 * in relief/gl.h. SPDX-License-Identifier: MIT */
#ifndef RELIEF_RELIEF_H
#define RELIEF_RELIEF_H

#include "relief/base.h"
#include "relief/camera.h"
#include "relief/compositor.h"
#include "relief/frame.h"
#include "relief/image.h"
#include "relief/known.h"
#include "relief/math.h"
#include "relief/model.h"
#include "relief/pipeline.h"
#include "relief/query.h"
#include "relief/reconstruct.h"
#include "relief/snapshot.h"
#include "relief/source.h"
#include "relief/surface.h"
#include "relief/synthetic.h"
#include "relief/world.h"

#endif
