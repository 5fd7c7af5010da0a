// SceneEdits.h - a scene, and edits of each member that images depend on. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Scene.h"

#include <functional>
#include <vector>

namespace osgRayTrace::engine::test
{

/// Returns a scene with a part of each kind.
Scene someScene();

using Edit = std::function<void(Scene&)>;

Edit ofMesh(const std::function<void(Mesh&)>& edit);
Edit ofTexture(const std::function<void(Texture&)>& edit);

/// Returns edits of each member that images depend on: whoever adds a member adds one here. Some
/// make scenes that nobody could trace.
std::vector<Edit> edits();

} // namespace osgRayTrace::engine::test
