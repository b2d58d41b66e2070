/** React Flow alone with as many nodes of its usual kind, set out as in the hall: what the map is measured beside. */
import { ReactFlow } from "@xyflow/react";
import "@xyflow/react/dist/style.css";
import { createElement } from "react";
import { createRoot } from "react-dom/client";

const count = Number(new URLSearchParams(location.search).get("nodes"));
const COLUMNS = 40;
const spread = count > 100 ? Math.floor(2000 / count) : 1;
const nodes = Array.from({ length: count }, (_, index) => {
  const place = index * spread;
  return {
    id: `n${index}`,
    position: { x: (place % COLUMNS) * 129, y: Math.floor(place / COLUMNS) * 67 },
    data: { label: `Step ${index}` },
    width: 110,
    height: 36,
  };
});
const edges = nodes.slice(1).map((node, index) => ({ id: `e${index}`, source: `n${index}`, target: node.id }));

createRoot(document.getElementById("root")).render(
  createElement(ReactFlow, {
    defaultNodes: nodes,
    defaultEdges: edges,
    minZoom: 0.1,
    onlyRenderVisibleElements: true,
    panOnDrag: true,
    fitView: true,
  }),
);
