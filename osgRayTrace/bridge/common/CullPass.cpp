// CullPass.cpp - clones the cull visitor of a pass. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/CullPass.h"

#include <typeinfo>
#include <utility>

namespace osgRayTrace::engine
{

std::shared_ptr<CullPass> cullPass(osgUtil::CullVisitor& visitor, std::shared_ptr<CullPass> last)
{
    osg::ref_ptr<osgUtil::CullVisitor> original;
    if (last && last->original.lock(original) && original == &visitor) return last;

    auto pass = std::make_shared<CullPass>();
    pass->original = &visitor;
    pass->visitor = visitor.clone();
    const osgUtil::CullVisitor* clone = pass->visitor.get();
    pass->isClone = clone && typeid(*clone) == typeid(visitor);
    osgUtil::RenderStage* stage = visitor.getCurrentRenderStage();
    pass->camera = stage ? stage->getCamera() : nullptr;
    pass->view = visitor.getRenderInfo().getView();
    pass->frameStamp = const_cast<osg::FrameStamp*>(visitor.getFrameStamp());
    return pass;
}

} // namespace osgRayTrace::engine
