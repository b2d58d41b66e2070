/** Chips under the pointer move at once; the document hears of it when they are let go. */
import { applyNodeChanges, type Node, type NodeChange, type NodePositionChange } from "@xyflow/react";
import { useCallback, useEffect, useLayoutEffect, useMemo, useRef, useState } from "react";
import { toMetres, toPixels, type Point } from "@/map/plane/projection";
import { useFingers } from "../touch/fingers";
import type { Chip } from "../scene/chips";
import type { Scene } from "../scene/scene";
import type { Guide, Snapped } from "./snapping";
import type { StageNode } from "./nodes";

export interface MovedNode {
  readonly id: string;
  /** Where it stands now. */
  readonly at: Point;
  /** Where it was let go, before it snapped. */
  readonly pointed: Point;
}

/** Who hears of it. */
interface Moving {
  readonly onMove?: (moved: readonly MovedNode[]) => void;
  readonly scene: Pick<Scene, "chips">;
  readonly looks: { readonly selected: ReadonlySet<string> };
  readonly onDragging?: (held: Readonly<Record<string, Point>> | null) => void;
}

export interface MovingNodes {
  readonly nodes: StageNode[];
  readonly guides: readonly Guide[];
  readonly onNodesChange: (changes: NodeChange<StageNode>[]) => void;
  /** Without a node where what was dragged is no longer there. */
  readonly onDragStop: (event: unknown, node: Node | undefined, nodes: Node[]) => void;
  readonly onSelectionDragStop: (event: unknown, nodes: Node[]) => void;
}

const NO_GUIDES: readonly Guide[] = [];

export function useMovingNodes(
  built: StageNode[],
  { onMove, onDragging, scene, looks }: Moving,
  snapTo: (id: string, at: { x: number; y: number }) => Snapped,
): MovingNodes {
  const [nodes, setNodes] = useState(built);
  const [guides, setGuides] = useState(NO_GUIDES);
  const dragging = useRef(new Set<string>());
  const snapped = useRef(new Map<string, { x: number; y: number }>());
  // Somebody else may take away what is held; the pointer goes on telling of it until it is let go.
  const there = useMemo(() => new Set(built.map(({ id }) => id)), [built]);
  useLayoutEffect(() => {
    const gone = [...dragging.current].filter((id) => !there.has(id));
    for (const id of gone) dragging.current.delete(id);
    if (gone.length === 0 || dragging.current.size > 0) return;
    snapped.current.clear();
    setGuides(NO_GUIDES);
    onDragging?.(null);
  }, [there, onDragging]);
  // Before the frame is painted: a press may follow at once upon what has just become a node.
  useLayoutEffect(() => {
    setNodes((now) => (dragging.current.size === 0 ? built : keepDragged(built, now, dragging.current)));
  }, [built]);
  useGivenUp(
    useCallback(() => {
      if (dragging.current.size === 0) return;
      dragging.current.clear();
      snapped.current.clear();
      setGuides(NO_GUIDES);
      setNodes(built);
      onDragging?.(null);
    }, [built, onDragging]),
  );
  const onNodesChange = useCallback(
    (changes: NodeChange<StageNode>[]) => {
      const moves = changes.filter((change) => change.type === "position").filter(({ id }) => there.has(id));
      if (moves.length === 0 || useFingers.getState().several) return;
      for (const move of moves) if (move.dragging) dragging.current.add(move.id);
      const [placed, lines] =
        dragging.current.size === 1 ? snapMoves(moves, snapTo, snapped.current) : [moves, NO_GUIDES];
      setGuides(lines);
      setNodes((now) => applyNodeChanges<StageNode>(placed, now));
      const held = placed.flatMap(({ id, position, dragging: drags }) =>
        position && drags ? [[id, toMetres(position)] as const] : [],
      );
      if (held.length > 0) onDragging?.(Object.fromEntries(held));
    },
    [snapTo, onDragging, there],
  );
  const drop = useCallback(
    (dropped: readonly Node[]) => {
      const moved = dropped.map((node) => ({
        id: node.id,
        at: toMetres(snapped.current.get(node.id) ?? node.position),
        pointed: toMetres(node.position),
      }));
      dragging.current.clear();
      snapped.current.clear();
      setGuides(NO_GUIDES);
      onDragging?.(null);
      if (moved.length > 0) onMove?.(withTheRest(moved, scene.chips, looks.selected));
    },
    [onMove, onDragging, scene, looks.selected],
  );
  return {
    nodes,
    guides,
    onNodesChange,
    onDragStop: useCallback((_event, node, all) => drop(all.length > 0 || !node ? all : [node]), [drop]),
    onSelectionDragStop: useCallback((_event, all) => drop(all), [drop]),
  };
}

/** A second finger never moves a node: React Flow ends the drag then, and says so to nobody. */
function useGivenUp(giveUp: () => void): void {
  useEffect(
    () =>
      useFingers.subscribe((now, before) => {
        if (now.several && !before.several) giveUp();
      }),
    [giveUp],
  );
}

/** Of very many that are selected not all have nodes: those without go as far as the one that was dragged. */
export function withTheRest(
  moved: readonly MovedNode[],
  chips: ReadonlyMap<string, Pick<Chip, "at">>,
  selected: ReadonlySet<string>,
): readonly MovedNode[] {
  const lead = moved.find(({ id }) => selected.has(id));
  const before = lead && chips.get(lead.id);
  if (!lead || !before) return moved;
  const to = toPixels(lead.at);
  const [dx, dy] = [to.x - before.at.x, to.y - before.at.y];
  const own = new Set(moved.map(({ id }) => id));
  const rest = [...selected].flatMap((id) => {
    const chip = own.has(id) ? undefined : chips.get(id);
    if (!chip) return [];
    const at = toMetres({ x: chip.at.x + dx, y: chip.at.y + dy });
    return [{ id, at, pointed: at }];
  });
  return [...moved, ...rest];
}

/** The one node that is held goes where it snaps to; the last of these places is remembered. */
function snapMoves(
  moves: readonly NodePositionChange[],
  snapTo: (id: string, at: { x: number; y: number }) => Snapped,
  snapped: Map<string, { x: number; y: number }>,
): [NodePositionChange[], readonly Guide[]] {
  let guides = NO_GUIDES;
  const placed = moves.map((move) => {
    if (!move.position || !move.dragging) return { ...move, position: snapped.get(move.id) ?? move.position };
    const goal = snapTo(move.id, move.position);
    snapped.set(move.id, goal.at);
    guides = goal.guides;
    return { ...move, position: goal.at };
  });
  return [placed, guides];
}

/** Chips that others hold are drawn where they hold them. */
export function withCarried(nodes: StageNode[], carried: ReadonlyMap<string, Point> | undefined): StageNode[] {
  if (!carried || carried.size === 0) return nodes;
  return nodes.map((node) => {
    const at = carried.get(node.id);
    return at ? { ...node, position: toPixels(at) } : node;
  });
}

/** Other people's changes go on while a chip is held; the held one stays under the pointer. */
function keepDragged(built: StageNode[], now: readonly StageNode[], held: ReadonlySet<string>): StageNode[] {
  const positions = new Map(now.map((node) => [node.id, node.position]));
  return built.map((node) => {
    const position = held.has(node.id) ? positions.get(node.id) : undefined;
    return position ? { ...node, position } : node;
  });
}
