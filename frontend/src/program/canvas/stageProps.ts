/** What a map with a program on it is given, and what it tells of. */
import type { ConnectionLineComponent } from "@xyflow/react";
import type { ReactNode } from "react";
import type { FloorPlan } from "@/map/floor/floor";
import type { Insets, Point } from "@/map/plane/projection";
import type { RobotSource } from "@/map/robots/robots";
import type { Scene } from "../scene/scene";
import type { SiteDevice } from "../surroundings";
import type { NodeLooks } from "./buildNodes";
import type { DrawingProps } from "./Drawing";
import type { StageNode } from "./nodes";
import type { MovedNode } from "./useMovingNodes";

export interface StagePress {
  readonly at: Point;
  readonly add: boolean;
}

export interface MapStageProps {
  plan: FloorPlan | null;
  devices: readonly SiteDevice[];
  scene: Scene;
  looks: NodeLooks;
  robots?: RobotSource;
  trails?: boolean;
  insets: Insets;
  label: string;
  mode: "select" | "pan" | "draw";
  /** Presses go through steps, lines and machines to the floor. */
  onlyFloor?: boolean;
  lines?: Pick<DrawingProps, "onSelectLink" | "chosenLink" | "targetWords" | "onSwap" | "swapLabel">;
  onStep?: (step: string, add: boolean) => void;
  onEditStep?: (step: string) => void;
  onDevice?: (device: string, press: StagePress) => void;
  onDeviceDown?: (device: string) => void;
  onDeviceUp?: (device: string) => void;
  onFloor?: (press: StagePress) => void;
  onBack?: () => void;
  onMove?: (moved: readonly MovedNode[]) => void;
  onMoveStart?: (at: Point) => void;
  /** Where others hold chips at this moment. */
  carried?: ReadonlyMap<string, Point>;
  /** Where this person holds chips; null once they are let go. */
  onDragging?: (held: Readonly<Record<string, Point>> | null) => void;
  onSelectMany?: (steps: readonly string[]) => void;
  /** The line from a dot to the pointer, and what letting go there would mean. */
  joinLine?: ConnectionLineComponent<StageNode>;
  /** A dot let go over a step; `at` in pixels of the window. */
  onJoin?: (from: string, to: string, at: { x: number; y: number }) => void;
  /** This person moved the map, as against the program. */
  onOwnPan?: () => void;
  onPointer?: (at: Point) => void;
  /** In the map's plane (drawing pixels), under all that is drawn. */
  under?: ReactNode;
  /** More in the map's plane. */
  plane?: ReactNode;
  /** More over the map, not moving with it. */
  children?: ReactNode;
}
