// ViewingConditions.h - the inputs that a conversion takes from the pass. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/CullPass.h"
#include "osgRayTrace/bridge/common/ReferenceView.h"
#include "osgRayTrace/bridge/common/ShaderState.h"

#include <osg/Light>
#include <osg/StateSet>
#include <osg/Vec3d>
#include <osg/Vec4>

#include <memory>
#include <vector>

namespace osgUtil
{
class CullVisitor;
}

namespace osgRayTrace::engine
{

/// Holds the conditions in the scene's own coordinates: those of the node that cull has reached.
struct ViewingConditions
{
    osg::Vec3d eye;
    std::optional<ReferenceView> view;        ///< nothing if there is no viewport
    std::shared_ptr<CullPass> pass;           ///< null: no cull traversal has reached the scene
    unsigned int traversalMask = 0xffffffffu; ///< of all views together
    /// Masks of the views, in rising order; empty: they have the same.
    std::vector<unsigned int> viewMasks;

    /// Copy of the first light that the pass had when it came to the scene; null: none. The light
    /// is osgViewer's own, which is in no graph, unless the viewer has none.
    osg::ref_ptr<const osg::Light> light;
    bool lightInEyeSpace = true;

    /// State sets above the place, the outermost first; no thread of OSG's changes them.
    std::vector<osg::ref_ptr<const osg::StateSet>> inheritedState;

    osg::Vec4 clearColor{0.2f, 0.2f, 0.4f, 1.0f};

    /// Uniforms and user values whose changes count, by the rules of a material file; null: none.
    std::shared_ptr<const ShaderReads> reads;
};

/// Returns the conditions of the visitor's pass at the visitor's place, without the pass. Cull
/// thread.
ViewingConditions viewingConditions(osgUtil::CullVisitor& visitor);

/// Returns whether a scene converted for a need not be converted again for b as a whole. The eye,
/// the view, the inherited state, the background and the light's values are not compared.
bool convertAlike(const ViewingConditions& a, const ViewingConditions& b);

/// Returns whether the background and the light, as of a scene converted for before, have not
/// changed. What has changed by rounding alone, or too little to be seen, becomes what it was: so
/// small steps add up from frame to frame until they count.
bool keepSame(const ViewingConditions& before, ViewingConditions& now);

} // namespace osgRayTrace::engine
