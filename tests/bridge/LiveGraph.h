// LiveGraph.h - a small scene graph that is edited, and a view of it without OpenGL. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/update/SceneUpdater.h"
#include "osgRayTrace/session/view/ViewTracer.h"

#include <osg/LightSource>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/PositionAttitudeTransform>
#include <osg/Texture2D>

#include <string>
#include <vector>

namespace osgRayTrace::test
{

/// Bumpy tiles side by side, each below a transform, with materials and one texture; a light.
struct LiveGraph
{
    static constexpr int kObjects = 6;

    LiveGraph();

    /// A tile of its own triangles and state at a place; nothing is added to the graph.
    osg::ref_ptr<osg::MatrixTransform> newObject(int number, double x, double y) const;

    osg::Geometry& geometry(int object) { return *objects[object]->getChild(0)->asGeometry(); }

    void deform(int object, float height);
    void shuffle(int object);      ///< exchanges vertices, so that all triangles are long
    void dropTriangle(int object); ///< the last one
    void paint(int red);           ///< the texture

    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osg::PositionAttitudeTransform> group = new osg::PositionAttitudeTransform;
    osg::ref_ptr<osg::MatrixTransform> hidden = new osg::MatrixTransform;
    osg::ref_ptr<osg::LightSource> light = new osg::LightSource;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    std::vector<osg::ref_ptr<osg::Material>> materials;
    std::vector<osg::ref_ptr<osg::MatrixTransform>> objects;
};

void deformTile(osg::Geometry& tile, float height);

/// What RayTraceDrawable does for a view, without it.
class LiveView
{
public:
    explicit LiveView(osg::Node* root);

    void update();

    /// As RayTracedScene::dirtyScene.
    void setDirty() { _updater.setDirty(); }

    /// Records another eye; what is traced stays the same view.
    void recordEye(const osg::Vec3d& eye);

    /// Traces a pass and resolves it: linear RGBA.
    const std::vector<float>& image();

    /// What image() gave last.
    const std::vector<float>& lastImage() const { return _last; }

    int passes() const { return _tracer.progress().passes; }
    Statistics statistics() const { return _updater.statistics(); }
    const engine::Scene* scene() const { return &_updater.version().inputs.scene->scene(); }

private:
    osg::Node* _root;
    osg::ref_ptr<RayTraceSettings> _settings = new RayTraceSettings;
    engine::SceneUpdater _updater;
    engine::ViewTracer _tracer;
    std::vector<float> _last;
};

/// So many passes of a scene that was converted just now.
std::vector<float> freshImage(const osg::Node& root, int passes);

/// Pixels where two images of one size are apart by more than rounding.
int differentPixels(const std::vector<float>& a, const std::vector<float>& b);

/// Updates, traces a pass and compares with a fresh conversion; all pixels if the update failed.
int wrongPixels(LiveView& view, const osg::Node& root);

/// Of 96 x 96: those where rounding decides which side of an edge a ray passes.
constexpr int kRoundedPixels = 8;

} // namespace osgRayTrace::test
