// Proxies.h - what OSG draws, but shadows, mirrors and light meet as well. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/textures/TextureConverter.h"
#include "osgRayTrace/bridge/common/StateStack.h"
#include "osgRayTrace/scene/Material.h"

#include <osg/Drawable>
#include <osg/Node>
#include <osg/StateSet>

#include <vector>

namespace osgRayTrace::engine
{

/// A proxy is the use of a geometry that OSG draws. Camera rays pass a proxy, because OSG's pixels
/// are there; shadow, mirror, bounce and photon rays meet the proxy.

/// Returns whether a drawable that OSG draws, at the end of a path and in this state, has a proxy.
/// pushed: the state sets that a cull traversal has pushed behind those of the path. It has one:
/// whether it is an opaque surface of the scene at the place that its vertices tell. Not so are
/// blended layers whose alpha a program computes, stencils, colour masks, lines, faces cut by clip
/// planes of the state, what does not test and write depth as a surface does, what is drawn in a
/// bin below 0 or with the eye, what a program draws from the inside alone or elsewhere than the
/// vertices tell, and what is hinted to have none. textures is as in rasterizedState.
bool hasProxy(const osg::Drawable& drawable, const osg::NodePath& path,
              const std::vector<osg::ref_ptr<const osg::StateSet>>& pushed, const GraphState& state,
              const TextureConverter& textures);

/// Returns the state of which a proxy's material is made. A program does not ask for GL_LIGHTING: a
/// surface below a program is lit, because an unlit one would shine on what is around it.
GraphState proxyState(const GraphState& state);

/// Makes a material one that camera rays pass, from both sides, and no other rays.
void hideFromCamera(Material& material);

} // namespace osgRayTrace::engine
