// GraphWatch.cpp - compares the nodes of a graph with what they were. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/GraphWatch.h"

#include "osgRayTrace/bridge/DrawHint.h"
#include "osgRayTrace/bridge/GraphCollector.h"
#include "osgRayTrace/bridge/GraphFingerprint.h"
#include "osgRayTrace/bridge/StateFingerprint.h"
#include "osgRayTrace/bridge/TriangleList.h"

#include <osg/Geode>
#include <osg/LightSource>
#include <osg/MatrixTransform>
#include <osg/PositionAttitudeTransform>
#include <osg/ShapeDrawable>
#include <osg/Switch>

#include <algorithm>
#include <cstring>
#include <typeinfo>

namespace osgRayTrace::engine
{

namespace
{

/// So far ahead memory is fetched, and these are the cache lines of it that are read.
constexpr std::size_t kAhead = 12;
constexpr int kNodeBegin = 3, kNodeEnd = 7, kBufferBegin = 0, kBufferEnd = 3;

inline void fetch(const void* object, int begin, int end)
{
    for (int line = begin; line < end; ++line)
        __builtin_prefetch(static_cast<const char*>(object) + 64 * line);
}

/// Mixes two numbers into one: both halves of their product.
inline uint64_t fold(uint64_t a, uint64_t b)
{
    const auto product =
        static_cast<unsigned __int128>(a ^ 0x9e3779b97f4a7c15u) * (b ^ 0xbf58476d1ce4e5b9u);
    return static_cast<uint64_t>(product) ^ static_cast<uint64_t>(product >> 64);
}

inline uint64_t bitsOf(const void* pointer)
{
    return reinterpret_cast<uintptr_t>(pointer);
}

/// Of an even number of doubles, two at a time and each pair apart from the others, which makes it
/// fast.
inline uint64_t printOfDoubles(const double* values, int count)
{
    uint64_t print = 0;
    for (int i = 0; i < count; i += 2)
    {
        uint64_t pair[2];
        std::memcpy(pair, values + i, sizeof pair);
        print +=
            fold(pair[0] + static_cast<uint64_t>(i), pair[1]) * (2 * static_cast<uint64_t>(i) + 1);
    }
    return print;
}

/// The library's own decorator: a plain group for this traversal.
bool isDecorator(const osg::Node& node)
{
    return std::strcmp(node.libraryName(), "osgRayTrace") == 0 &&
           std::strcmp(node.className(), "RayTracedScene") == 0;
}

uint64_t bufferPrint(const osg::BufferData& data)
{
    uint64_t count = 0, kind = 0;
    if (const osg::Array* array = data.asArray())
    {
        count = array->getNumElements();
        kind = static_cast<uint64_t>(array->getBinding());
    }
    else if (const osg::PrimitiveSet* set = data.asPrimitiveSet())
    {
        if (hasTriangles(*set)) count = set->getNumIndices(); // others may lack what they count
        kind = set->getMode();
        if (set->getType() ==
            osg::PrimitiveSet::DrawArraysPrimitiveType) // whose setFirst has no dirty()
            kind |= uint64_t(uint32_t(static_cast<const osg::DrawArrays*>(set)->getFirst())) << 32;
    }
    return fold(data.getModifiedCount() | count << 32, bitsOf(data.getDataPointer()) ^ kind << 8);
}

/// Calls f(buffer or null, whether it is of the shape) for what a mesh is made of.
template <class F> void forEachBuffer(const osg::Geometry& geometry, const F& f)
{
    f(geometry.getVertexArray(), true);
    f(geometry.getNormalArray(), true);
    f(geometry.getColorArray(), false);
    for (const osg::ref_ptr<osg::Array>& array : geometry.getTexCoordArrayList())
        f(array.get(), false);
    if (!geometry.getVertexArray())
        for (const osg::ref_ptr<osg::Array>& array : geometry.getVertexAttribArrayList())
            f(array.get(), false);
    for (const osg::ref_ptr<osg::PrimitiveSet>& set : geometry.getPrimitiveSetList())
        f(set.get(), true);
}

/// Most nodes have no descriptions, in which hints are kept.
uint64_t hintPrint(const osg::Node& node)
{
    return node.getUserDataContainer() ? static_cast<uint64_t>(ownHint(node)) : 0;
}

/// Which buffers it has, and what else decides on its conversion.
uint64_t geometryPrint(const osg::Geometry& geometry)
{
    uint64_t print = fold(bitsOf(geometry.getStateSet()) + hintPrint(geometry), geometry.getDataVariance());
    forEachBuffer(geometry, [&print](const osg::BufferData* data, bool)
                  { print = fold(print, bitsOf(data)); });
    return fold(print, bitsOf(geometry.getDrawCallback()));
}

/// What stands for the decorator has it below itself without being its parent.
osg::Node* soleNodeBelow(osg::Node& node, unsigned int traversalMask)
{
    struct Finder : osg::NodeVisitor
    {
        Finder() : osg::NodeVisitor(NODE_VISITOR, TRAVERSE_ACTIVE_CHILDREN) {}
        void apply(osg::Node& visited) override
        {
            if (getNodePath().size() > 1)
                found = &visited;
            else
                traverse(visited);
        }
        osg::Node* found = nullptr;
    } finder;
    finder.setTraversalMask(traversalMask);
    node.accept(finder);
    return finder.found;
}

} // namespace

void GraphWatch::forget()
{
    _recorded = false;
}

/// What stands for the decorator is looked through: it is no parent that would know of its end.
osg::Node* GraphWatch::firstNode(osg::Node& root) const
{
    if (!isVisible(root)) return nullptr;
    const bool stands = std::strcmp(root.className(), "SceneRoot") == 0 &&
                        std::strcmp(root.libraryName(), "osgRayTrace") == 0;
    return stands ? soleNodeBelow(root, _traversalMask) : &root;
}

void GraphWatch::record(osg::Node& root, const ViewingConditions& conditions)
{
    *this = GraphWatch();
    _traversalMask = conditions.traversalMask;
    _plain = conditions;
    _plain.inheritedState.clear();
    Digest inherited;
    for (const osg::ref_ptr<const osg::StateSet>& stateSet : conditions.inheritedState)
        addStateSet(inherited, *stateSet);
    _inheritedPrint = inherited.value();
    _first = firstNode(root);
    if (_first) recordNode(*_first, kNone, osg::Matrixd(), _first == &root ? 1 : 2);
    std::unordered_map<const void*, uint32_t>().swap(_known); // its buckets, too
    _slots.shrink_to_fit();
    _places.shrink_to_fit();
    _visits.shrink_to_fit();
    _recorded = true;
}

bool GraphWatch::isVisible(const osg::Node& node) const
{
    return (_traversalMask & node.getNodeMask()) != 0;
}

/// By the class itself: one derived from it may do anything.
GraphWatch::Kind GraphWatch::kindOf(const osg::Node& node)
{
    const std::type_info& type = typeid(node);
    if (type == typeid(osg::Geometry) || type == typeid(osg::ShapeDrawable)) return Kind::Geometry;
    const osg::Transform* transform = node.asTransform();
    if (transform && transform->getReferenceFrame() != osg::Transform::RELATIVE_RF)
        return Kind::Opaque; // where it is depends on the view
    if (type == typeid(osg::MatrixTransform)) return Kind::MatrixTransform;
    if (type == typeid(osg::PositionAttitudeTransform)) return Kind::PositionAttitudeTransform;
    if (type == typeid(osg::Group) || type == typeid(osg::Geode)) return Kind::Group;
    if (type == typeid(osg::Switch)) return Kind::Switch;
    if (type == typeid(osg::LightSource)) return Kind::Light;
    return isDecorator(node) ? Kind::Group : Kind::Opaque;
}

/// What decides on the matrix of a transform.
uint64_t GraphWatch::matrixPrint(const Slot& slot)
{
    if (slot.kind == Kind::MatrixTransform)
        return printOfDoubles(
            static_cast<const osg::MatrixTransform*>(slot.node)->getMatrix().ptr(), 16);
    const auto& t = static_cast<const osg::PositionAttitudeTransform&>(*slot.node);
    double values[14] = {};
    std::memcpy(values, t.getPosition().ptr(), 3 * sizeof(double));
    for (int i = 0; i < 4; ++i)
        values[3 + i] = t.getAttitude()[i];
    std::memcpy(values + 7, t.getScale().ptr(), 3 * sizeof(double));
    std::memcpy(values + 10, t.getPivotPoint().ptr(), 3 * sizeof(double));
    return printOfDoubles(values, 14);
}

GraphWatch::Slot& GraphWatch::addSlot(osg::Node& node, Kind kind, uint32_t place)
{
    Slot& slot = _slots.emplace_back();
    slot.node = &node;
    slot.kind = kind;
    slot.place = place;
    slot.repeated = !_known.try_emplace(&node, 0).second;
    return slot;
}

void GraphWatch::recordState(const osg::Node& node)
{
    const osg::StateSet* stateSet = node.getStateSet();
    if (!stateSet || !_known.try_emplace(stateSet, 0).second) return;
    Digest digest;
    addStateSet(digest, *stateSet);
    _states.push_back({stateSet, digest.value()});
}

/// Of all transforms around it: what is here is not only a matter of matrices.
void GraphWatch::fix(uint32_t place)
{
    for (; place != kNone && !_places[place].fixed;
         place = _places[place].outer == kOutermost ? kNone : _places[place].outer)
        _places[place].fixed = 1;
}

void GraphWatch::recordNode(osg::Node& node, uint32_t place, const osg::Matrixd& sceneFromLocal,
                            std::size_t depth)
{
    if (!isVisible(node) || depth > kDeepestPath) return;
    const Kind kind = kindOf(node);
    if (kind == Kind::Geometry)
    {
        recordGeometry(static_cast<osg::Geometry&>(node), place);
        return;
    }
    if (kind == Kind::Opaque)
    {
        recordOpaque(node, place, sceneFromLocal);
        return;
    }

    const auto index = static_cast<uint32_t>(_slots.size());
    addSlot(node, kind, place);
    osg::Matrixd inner = sceneFromLocal;
    if (isTransform(kind))
    {
        Place here;
        here.slot = index;
        here.print = matrixPrint(_slots[index]);
        here.outer = place == kNone ? kOutermost : place;
        here.fixed = 0;
        place = static_cast<uint32_t>(_places.size());
        _places.push_back(here);
        _slots[index].place = place;
        static_cast<osg::Transform&>(node).computeLocalToWorldMatrix(inner, nullptr);
    }
    if (kind == Kind::Light) fix(place);
    if (!_slots[index].repeated)
    {
        _slots[index].print = printOf(_slots[index]);
        recordState(node);
    }
    osg::Group& parent = *node.asGroup();
    const auto* selector = kind == Kind::Switch ? static_cast<const osg::Switch*>(&node) : nullptr;
    for (unsigned int i = 0; i < parent.getNumChildren(); ++i)
        if (parent.getChild(i) && (!selector || selector->getValue(i)))
            recordNode(*parent.getChild(i), place, inner, depth + 1);
}

void GraphWatch::recordGeometry(osg::Geometry& geometry, uint32_t place)
{
    _visits.push_back({static_cast<uint32_t>(_slots.size()), _uses[&geometry]++});
    Slot& slot = addSlot(geometry, Kind::Geometry, place);
    if (slot.repeated) return;
    const auto index = static_cast<uint32_t>(_slots.size() - 1);
    forEachBuffer(geometry,
                  [this, index](const osg::BufferData* data, bool shape)
                  {
                      if (data) _buffers.push_back({data, bufferPrint(*data), index, shape});
                  });
    slot.print = printOf(slot);
    recordState(geometry);
}

void GraphWatch::recordOpaque(osg::Node& node, uint32_t place, const osg::Matrixd& sceneFromLocal)
{
    fix(place);
    Slot& slot = addSlot(node, Kind::Opaque, place);
    slot.repeated = false; // what is active in it may depend on where it is
    slot.first = static_cast<uint32_t>(_opaqueMatrices.size());
    _opaqueMatrices.push_back(sceneFromLocal);
    slot.print = printOf(slot);
}

/// Its state set, and its children in their order, the hidden ones told apart.
uint64_t GraphWatch::groupPrint(const osg::Node& node) const
{
    uint64_t print = bitsOf(node.getStateSet()) + hintPrint(node);
    const auto& group = static_cast<const osg::Group&>(node);
    for (unsigned int i = 0; i < group.getNumChildren(); ++i)
    {
        const osg::Node* child = group.getChild(i);
        print = fold(print, child ? bitsOf(child) + (isVisible(*child) ? 1 : 0) : 0);
    }
    return print;
}

uint64_t GraphWatch::printOf(const Slot& slot) const
{
    const osg::Node& node = *slot.node;
    switch (slot.kind)
    {
    case Kind::Group:
        return groupPrint(node);
    case Kind::Switch:
    {
        uint64_t print = groupPrint(node);
        for (const bool on : static_cast<const osg::Switch&>(node).getValueList())
            print = fold(print, on ? 1 : 2);
        return print;
    }
    case Kind::MatrixTransform:
    case Kind::PositionAttitudeTransform:
        return fold(groupPrint(node), static_cast<const osg::Transform&>(node).getReferenceFrame());
    case Kind::Light:
    {
        const auto& source = static_cast<const osg::LightSource&>(node);
        Digest digest;
        digest.add(source.getReferenceFrame());
        if (source.getLight()) addLight(digest, *source.getLight());
        return fold(groupPrint(node), digest.value());
    }
    case Kind::Geometry:
        return geometryPrint(static_cast<const osg::Geometry&>(node));
    case Kind::Opaque:
        return graphFingerprint(*slot.node, _plain, _opaqueMatrices[slot.first]);
    }
    return 0;
}

GraphChanges GraphWatch::look(osg::Node& root, const ViewingConditions& conditions)
{
    GraphChanges changes;
    if (!_recorded || conditions.traversalMask != _traversalMask || firstNode(root) != _first)
    {
        changes.convert = changes.record = true;
        return changes;
    }
    _plain.eye = conditions.eye;
    _plain.view = conditions.view;
    _moved.assign(_places.size(), false);
    _anyMoved = false;
    if (!lookAtNodes())
    {
        changes.convert = changes.record = true;
        return changes;
    }
    lookAtBuffers(changes);
    lookAtStates(changes);
    Digest inherited;
    for (const osg::ref_ptr<const osg::StateSet>& stateSet : conditions.inheritedState)
        addStateSet(inherited, *stateSet);
    changes.convert |= inherited.value() != _inheritedPrint;
    _inheritedPrint = inherited.value();
    if (_anyMoved) findMoved(changes);
    return changes;
}

/// False if more than matrices differs: nodes that follow may be gone.
bool GraphWatch::lookAtNodes()
{
    const std::size_t count = _slots.size();
    for (std::size_t i = 0; i < count; ++i)
    {
        if (i + kAhead < count) fetch(_slots[i + kAhead].node, kNodeBegin, kNodeEnd);
        const Slot& slot = _slots[i];
        if (isTransform(slot.kind))
        {
            Place& place = _places[slot.place];
            const uint64_t print = matrixPrint(slot);
            if (print != place.print)
            {
                place.print = print;
                _moved[slot.place] = true;
                _anyMoved = true;
            }
        }
        if (!slot.repeated && printOf(slot) != slot.print) return false;
    }
    return true;
}

void GraphWatch::lookAtBuffers(GraphChanges& changes)
{
    const std::size_t count = _buffers.size();
    for (std::size_t i = 0; i < count; ++i)
    {
        if (i + kAhead < count) fetch(_buffers[i + kAhead].data, kBufferBegin, kBufferEnd);
        Buffer& buffer = _buffers[i];
        const uint64_t print = bufferPrint(*buffer.data);
        if (print == buffer.print) continue;
        buffer.print = print;
        changes.convert |= !buffer.shape; // it may be a part of the material
        const auto* geometry = static_cast<const osg::Geometry*>(_slots[buffer.slot].node);
        if (buffer.shape && (changes.deformed.empty() || changes.deformed.back() != geometry))
            changes.deformed.push_back(geometry);
    }
}

void GraphWatch::lookAtStates(GraphChanges& changes)
{
    for (StatePrint& state : _states)
    {
        Digest digest;
        addStateSet(digest, *state.stateSet);
        changes.convert |= digest.value() != state.print;
        state.print = digest.value();
    }
}

/// Takes the places from the outside to the inside, as they are in their array.
void GraphWatch::findMoved(GraphChanges& changes)
{
    std::unordered_map<uint32_t, osg::Matrixd> matrices; // few move
    for (std::size_t i = 0; i < _places.size(); ++i)
    {
        const Place& place = _places[i];
        if (place.outer != kOutermost && _moved[place.outer]) _moved[i] = true;
        if (_moved[i] && place.fixed) changes.convert = changes.record = true;
    }
    if (changes.convert) return;

    const auto matrixOf = [&](uint32_t index, const auto& self) -> const osg::Matrixd&
    {
        const auto known = matrices.find(index);
        if (known != matrices.end()) return known->second;
        const Place& place = _places[index];
        osg::Matrixd result;
        if (place.outer != kOutermost) result = self(place.outer, self);
        static_cast<const osg::Transform*>(_slots[place.slot].node)
            ->computeLocalToWorldMatrix(result, nullptr);
        return matrices[index] = result;
    };
    for (const Visit& visit : _visits)
    {
        const Slot& slot = _slots[visit.slot];
        if (slot.place == kNone || !_moved[slot.place]) continue;
        const auto* geometry = static_cast<const osg::Geometry*>(slot.node);
        changes.moved.push_back(
            {geometry, visit.use, _uses[geometry], matrixOf(slot.place, matrixOf)});
    }
}

} // namespace osgRayTrace::engine
