// FrameTimes.cpp - frame times of what OSG draws alone, plain and below a RayTracedScene. Layer:
// tests.
// SPDX-License-Identifier: MIT
//
// frameTimes [--pairs N] [--only NAME] [MODEL ...] draws blocks with a shader program, the same
// below a cull callback and below one for each, texts, and each model with a hint that leaves it to
// OSG. Processes take turns: one shows the graph, the next one shows it below a RayTracedScene, as
// a program shows either; two views of one process would drive each other out of the caches. It
// prints the medians of the processor time of a frame, and the median of the ratios of neighbouring
// processes. Exit code: 0 all ratios are at most 1.1, 1 some are not, 2 a model cannot be read, or
// a process has ended before its time.
#include <osgRayTrace/RayTracedScene>
#include <osgRayTrace/offscreen/OffscreenContext>

#include <osg/GL>
#include <osg/MatrixTransform>
#include <osg/Program>
#include <osg/ShapeDrawable>
#include <osgDB/ReadFile>
#include <osgText/Text>
#include <osgUtil/CullVisitor>
#include <osgViewer/Viewer>

#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

using namespace osgRayTrace;

namespace
{

constexpr int kWidth = 640, kHeight = 480;
constexpr int kSide = 30;     ///< blocks or texts in a row
constexpr int kWarmUp = 10;   ///< frames that are not counted: the graph is converted and compiled
constexpr int kFrames = 100;  ///< frames of a process that are
constexpr double kGoal = 1.1; ///< largest ratio
int pairs = 9;                ///< pairs of processes
std::string only;             ///< part of the names of what is measured

struct Finish : osg::Camera::DrawCallback
{
    void operator()(osg::RenderInfo&) const override { glFinish(); }
};

/// Pushes a uniform, as applications do in cull: the subtree is captured in each update.
struct UniformPusher : osg::NodeCallback
{
    UniformPusher() { states->addUniform(new osg::Uniform("brightness", 1.0f)); }
    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        osgUtil::CullVisitor* cull = visitor->asCullVisitor();
        if (cull) cull->pushStateSet(states);
        traverse(node, visitor);
        if (cull) cull->popStateSet();
    }
    const osg::ref_ptr<osg::StateSet> states = new osg::StateSet;
};

/// Shows a scene from where all of it is seen.
class Window
{
public:
    Window(osg::Node* scene, const osg::BoundingSphere& bound)
    {
        _viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
        osg::Camera& camera = *_viewer.getCamera();
        camera.setGraphicsContext(createOSMesaContext(kWidth, kHeight));
        camera.setViewport(0, 0, kWidth, kHeight);
        camera.setProjectionMatrixAsPerspective(40.0, double(kWidth) / kHeight, 1.0, 100.0);
        const osg::Vec3d centre = bound.center();
        camera.setViewMatrixAsLookAt(centre + osg::Vec3d(0.3, -2.4, 1.4) * bound.radius(), centre,
                                     osg::Vec3d(0.0, 0.0, 1.0));
        camera.addFinalDrawCallback(new Finish);
        _viewer.setSceneData(scene);
        _viewer.realize();
    }

    /// Draws a frame and returns the processor time that it took [s].
    double frame()
    {
        const double begin = seconds();
        _viewer.frame();
        return seconds() - begin;
    }

private:
    static double seconds()
    {
        timespec time;
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
        return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
    }

    osgViewer::Viewer _viewer;
};

double median(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

/// Returns the median of the processor times of a frame [s].
double frameTime(osg::Node& graph, bool traced)
{
    osg::ref_ptr<osg::Node> shown = &graph;
    if (traced)
    {
        const osg::ref_ptr<RayTracedScene> scene = new RayTracedScene;
        scene->addChild(&graph);
        shown = scene;
    }
    Window window(shown, graph.getBound());
    for (int i = 0; i < kWarmUp; ++i)
        window.frame();
    std::vector<double> times;
    for (int i = 0; i < kFrames; ++i)
        times.push_back(window.frame());
    return median(times);
}

/// Returns frameTime() of a process of its own.
double frameTimeApart(osg::Node& graph, bool traced)
{
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("no process");
    double time = 0.0;
    if (child == 0)
    {
        time = frameTime(graph, traced);
        _exit(write(ends[1], &time, sizeof time) == sizeof time ? 0 : 1);
    }
    close(ends[1]);
    const bool whole = read(ends[0], &time, sizeof time) == sizeof time;
    close(ends[0]);
    waitpid(child, nullptr, 0);
    if (!whole) throw std::runtime_error("a process has ended before its time");
    return time;
}

/// Returns whether the ratio is that of the goal.
bool measure(const std::string& name, osg::Node& graph)
{
    if (name.find(only) == std::string::npos) return true;
    std::vector<double> plains, traceds, ratios;
    for (int pair = 0; pair < pairs; ++pair)
    {
        plains.push_back(frameTimeApart(graph, false));
        traceds.push_back(frameTimeApart(graph, true));
        ratios.push_back(traceds.back() / plains.back());
    }
    const double ratio = median(ratios);
    std::printf("%-28s plain %.2f ms, below a RayTracedScene %.2f ms: %.3f\n", name.c_str(),
                1e3 * median(plains), 1e3 * median(traceds), ratio);
    std::fflush(stdout);
    return ratio <= kGoal;
}

osg::ref_ptr<osg::Node> field(const osg::ref_ptr<osg::Drawable>& shared)
{
    const osg::ref_ptr<osg::Group> group = new osg::Group;
    for (int i = 0; i < kSide * kSide; ++i)
    {
        const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(
            osg::Matrix::translate(i % kSide - 0.5 * kSide, i / kSide - 0.5 * kSide, 0.0));
        place->addChild(shared);
        group->addChild(place);
    }
    return group;
}

osg::ref_ptr<osg::Node> shadedBlocks()
{
    const osg::ref_ptr<osg::Node> blocks =
        field(new osg::ShapeDrawable(new osg::Box(osg::Vec3(), 0.7f)));
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT,
                                       "void main() { gl_FragColor = vec4(0.2, 0.6, 0.9, 1.0); }"));
    blocks->getOrCreateStateSet()->setAttributeAndModes(program);
    return blocks;
}

osg::ref_ptr<osg::Node> texts()
{
    const osg::ref_ptr<osgText::Text> text = new osgText::Text;
    text->setText("text");
    text->setCharacterSize(0.4f);
    return field(text);
}

/// Returns the exit code.
int run(int count, char** arguments)
{
    setenv("LP_NUM_THREADS", "0", 1); // Mesa rasterizes on the thread that draws
    bool right = true;
    int first = 1;
    for (; first + 1 < count && std::strncmp(arguments[first], "--", 2) == 0; first += 2)
        if (std::strcmp(arguments[first], "--pairs") == 0)
            pairs = std::max(3, std::atoi(arguments[first + 1]));
        else if (std::strcmp(arguments[first], "--only") == 0)
            only = arguments[first + 1];
    right &= measure("blocks with a program", *shadedBlocks());
    right &= measure("texts", *texts());
    const osg::ref_ptr<osg::Node> captured = shadedBlocks();
    captured->setCullCallback(new UniformPusher);
    right &= measure("blocks below a callback", *captured);
    const osg::ref_ptr<osg::Node> each = shadedBlocks();
    for (unsigned int i = 0; i < each->asGroup()->getNumChildren(); ++i)
        each->asGroup()->getChild(i)->setCullCallback(new UniformPusher);
    right &= measure("blocks with callbacks", *each);
    for (int i = first; i < count; ++i)
    {
        const osg::ref_ptr<osg::Node> model = osgDB::readRefNodeFile(arguments[i]);
        if (!model) return 2;
        const osg::ref_ptr<osg::Group> left = new osg::Group;
        left->addChild(model);
        RayTracedScene::setHint(left, RayTracedScene::RASTERIZE);
        right &= measure(arguments[i], *left);
    }
    return right ? 0 : 1;
}

} // namespace

int main(int count, char** arguments)
try
{
    return run(count, arguments);
}
catch (const std::exception& error)
{
    std::fprintf(stderr, "frameTimes: %s\n", error.what());
    return 2;
}
