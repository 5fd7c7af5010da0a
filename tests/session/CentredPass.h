// CentredPass.h - the image of one pass through the middles of the pixels. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/Catch.h"
#include "tests/EngineScenes.h"

namespace osgRayTrace::engine::test
{

/// Renders the pass, by the Whitted integrator.
inline void renderCentredPass(RenderSession& session,
                              const std::shared_ptr<const TracedScene>& scene, const View& view)
{
    RenderOptions options = optionsOf(IntegratorKind::Whitted);
    options.centredFirstPass = true;
    session.setScene(scene);
    session.setView(view);
    session.setOptions(options);
    StopRule rule;
    rule.passes = 1;
    REQUIRE(session.render(rule).status.ok());
}

/// Renders the pass and returns its image.
inline ResolvedImage centredImage(RenderSession& session,
                                  const std::shared_ptr<const TracedScene>& scene, const View& view)
{
    renderCentredPass(session, scene, view);
    return session.resolvedImage();
}

} // namespace osgRayTrace::engine::test
