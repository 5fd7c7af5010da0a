// GraphWatch.h - finds what has changed in a scene graph, in next to no time if nothing has. Layer:
// bridge. SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/GraphChanges.h"
#include "osgRayTrace/bridge/ViewingConditions.h"

#include <osg/Node>
#include <osg/Transform>

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace osgRayTrace::engine
{

/// A graph as it was seen last: its visible nodes in the order of the traversal in one array, each
/// with a number made of its own values. A look compares them one after the other, without a
/// traversal. A node is read only after its parent was found to have it still, so nothing here
/// keeps nodes alive. Nodes of the plain classes are known one by one; of any other node (level of
/// detail, billboard, a class of the application's own) only whether anything in it and below it
/// has changed: see graphFingerprint, also for what goes unseen. Bounds are not looked at.
class GraphWatch
{
public:
    /// Remembers the graph as it is.
    void record(osg::Node& root, const ViewingConditions& conditions);

    /// The next look finds everything changed.
    void forget();

    /// What has changed in the graph below the same root since the last look or record(), under the
    /// same conditions but for the eye and the inherited state.
    GraphChanges look(osg::Node& root, const ViewingConditions& conditions);

private:
    static constexpr uint32_t kNone = 0xffffffffu;

    enum class Kind : uint8_t
    {
        Group,
        Switch,
        MatrixTransform,
        PositionAttitudeTransform,
        Light,
        Geometry,
        Opaque, ///< with all that is below it
    };

    struct Slot
    {
        osg::Node* node = nullptr;
        uint64_t print = 0;
        uint32_t place = kNone; ///< that it is in; a transform: its own
        uint32_t first = 0;     ///< Opaque: of _opaqueMatrices
        Kind kind = Kind::Group;
        bool repeated = false; ///< the same node came before: looked at there
    };

    /// A transform on a path.
    struct Place
    {
        uint64_t print = 0; ///< of its matrix
        uint32_t slot = 0;
        uint32_t outer : 31; ///< place around it; kOutermost: none
        uint32_t fixed : 1;  ///< there is more in it than plain nodes and geometry
    };
    static constexpr uint32_t kOutermost = 0x7fffffffu;

    struct Buffer
    {
        const osg::BufferData* data = nullptr;
        uint64_t print = 0;
        uint32_t slot = 0;  ///< of its geometry
        bool shape = false; ///< positions, normals or primitives
    };

    struct StatePrint
    {
        const osg::StateSet* stateSet = nullptr;
        uint64_t print = 0;
    };

    struct Visit
    {
        uint32_t slot = 0;
        uint32_t use = 0;
    };

    osg::Node* firstNode(osg::Node& root) const;
    void recordNode(osg::Node& node, uint32_t place, const osg::Matrixd& sceneFromLocal,
                    std::size_t depth);
    void recordGeometry(osg::Geometry& geometry, uint32_t place);
    void recordOpaque(osg::Node& node, uint32_t place, const osg::Matrixd& sceneFromLocal);
    void recordState(const osg::Node& node);
    Slot& addSlot(osg::Node& node, Kind kind, uint32_t place);
    void fix(uint32_t place);

    static Kind kindOf(const osg::Node& node);
    static bool isTransform(Kind kind)
    {
        return kind == Kind::MatrixTransform || kind == Kind::PositionAttitudeTransform;
    }
    static uint64_t matrixPrint(const Slot& slot);
    uint64_t printOf(const Slot& slot) const;
    uint64_t groupPrint(const osg::Node& node) const;
    bool isVisible(const osg::Node& node) const;
    bool lookAtNodes();
    void lookAtBuffers(GraphChanges& changes);
    void lookAtStates(GraphChanges& changes);
    void findMoved(GraphChanges& changes);

    bool _recorded = false;
    osg::Node* _first = nullptr; ///< of the slots; null: nothing is visible. A name, not followed
    unsigned int _traversalMask = 0xffffffffu;
    ViewingConditions _plain; ///< of the last look, without inherited state
    std::vector<Slot> _slots;
    std::vector<Place> _places;
    std::vector<Buffer> _buffers;
    std::vector<Visit> _visits;
    std::vector<StatePrint> _states;
    std::vector<osg::Matrixd> _opaqueMatrices;
    uint64_t _inheritedPrint = 0;
    std::unordered_map<const osg::Geometry*, uint32_t> _uses;

    // Of record() and look() while they run:
    std::unordered_map<const void*, uint32_t> _known;
    std::vector<bool> _moved; ///< by place
    bool _anyMoved = false;
};

} // namespace osgRayTrace::engine
