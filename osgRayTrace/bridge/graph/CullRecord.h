// CullRecord.h - what a cull traversal has left to draw, to be compared with the next one. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Drawable>
#include <osg/Matrixd>
#include <osg/StateSet>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace osgUtil
{
class RenderBin;
class RenderStage;
class StateGraph;
} // namespace osgUtil

namespace osgRayTrace::engine
{

/// Holds a drawable as a cull traversal leaves it to draw.
struct CapturedLeaf
{
    osg::ref_ptr<osg::Drawable> drawable;
    osg::Matrixd worldFromLocal;
    /// State sets from the captured node on, the outermost first; the drawable's own is the last.
    std::vector<osg::ref_ptr<const osg::StateSet>> states;
    bool isProjected = false; ///< a node below the captured one gives it a projection of its own
};

/// Holds the leaves of a cull traversal. Comparing them with those of the next traversal takes one
/// walk through its state graph, in which nothing is copied.
class CullRecord
{
public:
    /// Returns whether two state sets, which are different objects, have the same values.
    using SameState = std::function<bool(const osg::StateSet& then, const osg::StateSet& now)>;

    /// Takes what a traversal has put into a stage, in this view and with this projection. Returns
    /// true if the record had the same already: drawables, their order and state, and their places
    /// but for the rounding of a way through another view. No function: state sets are the same if
    /// they are the same object.
    bool take(osgUtil::RenderStage& stage, const osg::Matrixd& viewFromWorld,
              const osg::RefMatrix& projection, const SameState& sameState = {});

    /// Takes the message of an exception, with which a traversal has ended.
    void fail(std::string error);

    /// Returns the leaves in the order of the traversal.
    std::vector<CapturedLeaf> leaves() const;

    std::size_t size() const { return _entries.size(); }

    /// Returns whether cameras have drawn something of their own.
    bool otherStages() const { return _otherStages; }

    /// Returns the message of an exception of the application's; empty: there was none.
    const std::string& error() const { return _error; }

    /// Returns a hash of the drawables and the state sets, as objects.
    uint64_t signature() const;

    /// Returns the drawables of the leaves, each one once.
    const std::vector<osg::ref_ptr<osg::Drawable>>& drawables() const { return _drawables; }

    /// Returns the state sets of the leaves, each one once.
    const std::vector<osg::ref_ptr<const osg::StateSet>>& stateSets() const { return _stateSets; }

private:
    struct Entry
    {
        osg::Drawable* drawable = nullptr;
        osg::Matrixd viewFromLocal;  ///< in the view of the last traversal
        osg::Matrixd worldFromLocal; ///< of the first one that was the same
        uint32_t chain = 0;          ///< index of its state sets
        unsigned int order = 0;
        bool isProjected = false;
    };

    struct Comparison;

    bool repeats(const osgUtil::RenderBin& bin, Comparison& comparison);
    bool repeats(const osgUtil::StateGraph& graph, Comparison& comparison);
    void add(osgUtil::RenderBin& bin, const osg::RefMatrix& projection);
    void listObjects();

    std::vector<Entry> _entries; ///< bin by bin, of each the state graphs in their order
    std::vector<std::vector<const osg::StateSet*>> _chains; ///< the outermost first
    std::vector<osg::ref_ptr<osg::Drawable>> _drawables;
    std::vector<osg::ref_ptr<const osg::StateSet>> _stateSets;
    osg::Matrixd _viewFromWorld;
    bool _taken = false, _otherStages = false;
    std::string _error;
};

/// Returns whether two matrices are equal but for the rounding of a way through another view.
bool sameMatrix(const osg::Matrixd& a, const osg::Matrixd& b, double eyeDistance);

} // namespace osgRayTrace::engine
