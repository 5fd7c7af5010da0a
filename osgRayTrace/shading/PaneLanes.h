// PaneLanes.h - the light that passes clear panes straight, for sixteen rays. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/shading/SmoothLanes.h"

namespace osgRayTrace::engine
{

/// Returns true if straightTransmittance of the surface is more than zero and knows no layer but
/// the glass: no film, no clear coat and no sheen.
bool isClearPane(const Bsdf& bsdf);

/// Sets share to straightTransmittance(pane, cosine) of the rays at a surface of isClearPane. All
/// lanes are computed; those of rays without a meaning have none.
void clearPaneLanes(const Bsdf& pane, const IncidentLanes& incident, Vec3Lanes& share);

} // namespace osgRayTrace::engine
