// Turning.cpp - a model that a cull callback turns after its matrix was taken, so that the next
// cull traversal has it: a stand-in for FlightGear's animations of spins. Layer: tests.
// SPDX-License-Identifier: MIT
//
// Usage: turning MODEL.
#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgUtil/CullVisitor>
#include <osgViewer/Viewer>

namespace application
{

class Spin : public osg::NodeCallback
{
public:
    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        const double angle = 0.002 * visitor->getFrameStamp()->getFrameNumber();
        static_cast<osg::MatrixTransform*>(node)->setMatrix(
            osg::Matrix::rotate(angle, osg::Vec3d(0.0, 0.0, 1.0)));
        traverse(node, visitor);
    }
};

} // namespace application

int main(int argc, char** argv)
{
    const osg::ref_ptr<osg::Node> model =
        argc == 2 ? osgDB::readRefNodeFile(argv[1]) : osg::ref_ptr<osg::Node>();
    if (!model) return 2;
    const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
    place->setCullCallback(new application::Spin);
    place->addChild(model);
    osgViewer::Viewer viewer;
    viewer.setSceneData(place);
    return viewer.run();
}
