// SmallEdits.h - the cost of edits that touch one object of a large scene. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"
#include "apps/osgraytracebench/modes/LiveScene.h"
#include "apps/osgraytracebench/scenes/ObjectField.h"

namespace osgRayTrace::bench
{

/// Measures an edited material, light and texture, and an object that comes and goes. walk: the
/// time of an update that finds no change [s].
void measureSmallEdits(Rows& rows, ObjectField& field, LiveScene& live, BareField& bare,
                       double walk);

} // namespace osgRayTrace::bench
