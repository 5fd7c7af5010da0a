// DepthPartition.h - draws its children in slices of depth, as CalVR does. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Camera>
#include <osg/Group>
#include <osgUtil/CullVisitor>

#include <map>
#include <vector>

namespace osgRayTrace::test
{

/// Has a camera for each slice; the last slice is drawn first. Each camera clears depth and draws
/// all children with the matrices of the pass, but for the near and far planes of its slice. Each
/// eye has cameras of its own.
class DepthPartition : public osg::Group
{
public:
    explicit DepthPartition(const std::vector<double>& planes) : _planes(planes) {}

    void setPlanes(const std::vector<double>& planes) { _planes = planes; }

    void traverse(osg::NodeVisitor& visitor) override
    {
        osgUtil::CullVisitor* cull = visitor.asCullVisitor();
        if (!cull) return osg::Group::traverse(visitor);
        for (std::size_t i = _planes.size() - 1; i-- > 0;)
        {
            osg::Camera& camera = cameraOf(*cull, i);
            camera.removeChildren(0, camera.getNumChildren());
            for (unsigned int child = 0; child < getNumChildren(); ++child)
                camera.addChild(getChild(child));
            camera.setViewMatrix(*cull->getModelViewMatrix());
            camera.setViewport(cull->getViewport());
            camera.setProjectionMatrix(
                slice(*cull->getProjectionMatrix(), _planes[i], _planes[i + 1]));
            camera.accept(visitor);
        }
    }

private:
    using Cameras = std::vector<osg::ref_ptr<osg::Camera>>;

    osg::Camera& cameraOf(osgUtil::CullVisitor& visitor, std::size_t slice)
    {
        Cameras& cameras = _cameras[&visitor];
        while (cameras.size() <= slice)
        {
            osg::ref_ptr<osg::Camera> camera = new osg::Camera;
            camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
            camera->setRenderOrder(osg::Camera::POST_RENDER, -int(cameras.size()));
            camera->setClearMask(GL_DEPTH_BUFFER_BIT);
            camera->setCullingActive(false);
            camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
            cameras.push_back(camera);
        }
        return *cameras[slice];
    }

    static osg::Matrixd slice(osg::Matrixd projection, double zNear, double zFar)
    {
        if (projection(2, 3) == 0.0)
        {
            projection(2, 2) = -2.0 / (zFar - zNear);
            projection(3, 2) = -(zFar + zNear) / (zFar - zNear);
            return projection;
        }
        projection(2, 2) = -(zFar + zNear) / (zFar - zNear);
        projection(3, 2) = -2.0 * zFar * zNear / (zFar - zNear);
        return projection;
    }

    std::vector<double> _planes;
    std::map<osgUtil::CullVisitor*, Cameras> _cameras; ///< an eye has a visitor of its own
};

} // namespace osgRayTrace::test
