// Reads trees with BehaviorTree.CPP itself: registers what <TreeNodesModel> describes, builds the tree, ticks it once
// with every leaf succeeding, and prints how many nodes of which kind there are.
//
//     cmake -S BehaviorTree.CPP -B b -DBTCPP_SHARED_LIBS=OFF -DBTCPP_GROOT_INTERFACE=OFF -DBTCPP_SQLITE_LOGGING=OFF
//     make -C b behaviortree_cpp
//     g++ -std=c++17 -I BehaviorTree.CPP/include -I BehaviorTree.CPP/3rdparty/tinyxml2 accepts.cpp $(find b -name '*.a')
//     BTCPP_ACCEPTS=./a.out pytest tests/trees/btcpp
#include <iostream>
#include <map>
#include "behaviortree_cpp/bt_factory.h"
#include "tinyxml2.h"

struct Leaf : BT::SyncActionNode {
  using BT::SyncActionNode::SyncActionNode;
  BT::NodeStatus tick() override { return BT::NodeStatus::SUCCESS; }
};
struct Asked : BT::ConditionNode {
  using BT::ConditionNode::ConditionNode;
  BT::NodeStatus tick() override { return BT::NodeStatus::SUCCESS; }
};
struct First : BT::ControlNode {  // the body of a FailSafe or RecoverBy, the whole of a Stage
  using BT::ControlNode::ControlNode;
  BT::NodeStatus tick() override { return children()[0]->executeTick(); }
};

int main(int count, char** files) {
  for (int n = 1; n < count; n++) {
    tinyxml2::XMLDocument doc;
    if (doc.LoadFile(files[n])) { std::cout << files[n] << ": " << doc.ErrorStr() << "\n"; return 1; }
    BT::BehaviorTreeFactory factory;
    auto models = doc.RootElement()->FirstChildElement("TreeNodesModel");
    for (auto m = models->FirstChildElement(); m; m = m->NextSiblingElement()) {
      BT::PortsList ports;
      for (auto p = m->FirstChildElement(); p; p = p->NextSiblingElement()) {
        auto direction = std::string(p->Name()) == "output_port" ? BT::PortDirection::OUTPUT : BT::PortDirection::INPUT;
        ports.insert({p->Attribute("name"), BT::PortInfo(direction)});
      }
      std::string kind = m->Name(), id = m->Attribute("ID");
      if (kind == "Action") factory.registerBuilder<Leaf>(id, [](auto& n, auto& c) { return std::make_unique<Leaf>(n, c); });
      if (kind == "Condition") factory.registerBuilder<Asked>(id, [](auto& n, auto& c) { return std::make_unique<Asked>(n, c); });
      if (kind == "Control") factory.registerBuilder<First>(id, [](auto& n, auto& c) { return std::make_unique<First>(n, c); });
      BT::TreeNodeManifest manifest = factory.manifests().at(id);
      manifest.ports = ports;
      auto builder = factory.builders().at(id);
      factory.unregisterBuilder(id);
      factory.registerBuilder(manifest, builder);
    }
    try {
      auto tree = factory.createTreeFromFile(files[n]);
      std::map<std::string, int> kinds;
      int nodes = 0;
      tree.applyVisitor([&](BT::TreeNode* node) { kinds[node->registrationName()]++; nodes++; });
      auto status = tree.tickWhileRunning();
      std::cout << files[n] << ": accepted, " << nodes << " nodes, " << BT::toStr(status);
      for (auto& [kind, number] : kinds) std::cout << " " << kind << "=" << number;
      std::cout << "\n";
    } catch (std::exception& error) { std::cout << files[n] << ": refused: " << error.what() << "\n"; return 1; }
  }
}
