/** Chips under the pointer move at once; the document hears of it when they are let go. */
import { applyNodeChanges, type Node, type NodeChange } from "@xyflow/react";
import { useCallback, useEffect, useRef, useState } from "react";
import { toMetres, type Point } from "@/map/projection";
import type { StageNode } from "./nodes";

export interface MovingNodes {
  readonly nodes: StageNode[];
  readonly onNodesChange: (changes: NodeChange<StageNode>[]) => void;
  readonly onDragStop: (event: unknown, node: Node, nodes: Node[]) => void;
  readonly onSelectionDragStop: (event: unknown, nodes: Node[]) => void;
  readonly onSelectionEnd: () => void;
}

export function useMovingNodes(
  built: StageNode[],
  onMove: ((moved: readonly { id: string; at: Point }[]) => void) | undefined,
  onSelectMany: ((steps: readonly string[]) => void) | undefined,
): MovingNodes {
  const [nodes, setNodes] = useState(built);
  const dragging = useRef(new Set<string>());
  const boxed = useRef(new Set<string>());
  useEffect(() => {
    setNodes((now) => (dragging.current.size === 0 ? built : keepDragged(built, now, dragging.current)));
  }, [built]);
  const onNodesChange = useCallback((changes: NodeChange<StageNode>[]) => {
    for (const change of changes) {
      if (change.type === "position" && change.dragging) dragging.current.add(change.id);
      if (change.type === "select") {
        if (change.selected) boxed.current.add(change.id);
        else boxed.current.delete(change.id);
      }
    }
    const moves = changes.filter((change) => change.type === "position");
    if (moves.length > 0) setNodes((now) => applyNodeChanges(moves, now));
  }, []);
  const drop = useCallback(
    (dropped: readonly Node[]) => {
      dragging.current.clear();
      if (dropped.length > 0) onMove?.(dropped.map((node) => ({ id: node.id, at: toMetres(node.position) })));
    },
    [onMove],
  );
  return {
    nodes,
    onNodesChange,
    onDragStop: useCallback((_event, node, all) => drop(all.length > 0 ? all : [node]), [drop]),
    onSelectionDragStop: useCallback((_event, all) => drop(all), [drop]),
    onSelectionEnd: useCallback(() => {
      if (boxed.current.size > 0) onSelectMany?.([...boxed.current]);
      boxed.current.clear();
    }, [onSelectMany]),
  };
}

/** Other people's changes go on while a chip is held; the held one stays under the pointer. */
function keepDragged(built: StageNode[], now: readonly StageNode[], held: ReadonlySet<string>): StageNode[] {
  const positions = new Map(now.map((node) => [node.id, node.position]));
  return built.map((node) => {
    const position = held.has(node.id) ? positions.get(node.id) : undefined;
    return position ? { ...node, position } : node;
  });
}
