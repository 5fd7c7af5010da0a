// ForeignProgram.cpp - a program that knows OpenSceneGraph alone, and prints what its views show.
// Layer: tests.
// SPDX-License-Identifier: MIT
#include <osg/Group>
#include <osgViewer/CompositeViewer>
#include <osgViewer/Viewer>

#include <iostream>

namespace
{

void print(const char* what, osgViewer::View& view)
{
    const osg::Node* scene = view.getSceneData();
    std::cout << what << ' ' << (scene ? scene->className() : "nothing") << '\n';
}

} // namespace

int main()
{
    osg::ref_ptr<osg::Group> graph = new osg::Group;
    osgViewer::Viewer viewer;
    viewer.setSceneData(graph.get());
    print("viewer", viewer);
    const std::size_t handlers = viewer.getEventHandlers().size();
    viewer.setSceneData(graph.get()); // as programs do that have changed the graph
    std::cout << viewer.getEventHandlers().size() - handlers << " more handlers\n";
    viewer.setSceneData(nullptr);
    print("cleared", viewer);
    viewer.setSceneData(new osg::Group); // nobody but the view refers to it
    print("new", viewer);

    osgViewer::CompositeViewer composite;
    for (int i = 0; i < 2; ++i)
    {
        composite.addView(new osgViewer::View);
        composite.getView(i)->setSceneData(graph.get());
        print("view", *composite.getView(i));
    }
    const bool same = composite.getView(0)->getSceneData() == composite.getView(1)->getSceneData();
    std::cout << (same ? "shared" : "apart") << ' ' << graph->getNumParents() << '\n';
    return 7;
}
