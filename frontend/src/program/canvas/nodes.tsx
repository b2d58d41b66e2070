/** The kinds of node on the map: machines, steps, the start. */
import { Handle, Position, type Node, type NodeProps } from "@xyflow/react";
import { Play } from "lucide-react";
import type { LevelOfDetail } from "../scene/detail";
import classes from "./stage.module.css";
import { MachineNode, type MachineNodeProps } from "./MachineNode";
import { StepChip, type StepChipProps } from "./StepChip";

export type MachineFlowNode = Node<MachineNodeProps & Record<string, unknown>, "machine">;
export type StepFlowNode = Node<StepChipProps & { joinable: boolean } & Record<string, unknown>, "step">;
export type StartFlowNode = Node<{ label: string; detail: LevelOfDetail }, "start">;
export type StageNode = MachineFlowNode | StepFlowNode | StartFlowNode;

function Machine({ data }: NodeProps<MachineFlowNode>) {
  const { device, light, caption, side, gap, detail } = data;
  return <MachineNode device={device} light={light} caption={caption} side={side} gap={gap} detail={detail} />;
}

function Step({ data }: NodeProps<StepFlowNode>) {
  const { chip, selected, state, other, note, detail } = data;
  return (
    <>
      <StepChip chip={chip} selected={selected} state={state} other={other} note={note} detail={detail} />
      {data.joinable ? (
        <>
          <Handle type="target" position={Position.Top} className={classes.target} isConnectableStart={false} />
          <Handle type="source" position={Position.Bottom} className={classes.dot} />
        </>
      ) : null}
    </>
  );
}

function Start({ data }: NodeProps<StartFlowNode>) {
  return (
    <div className={classes.start} data-lod={data.detail}>
      <Play size={14} strokeWidth={2} aria-hidden="true" />
      <span>{data.label}</span>
      <Handle type="source" position={Position.Bottom} className={classes.dot} />
    </div>
  );
}

export const nodeTypes = { machine: Machine, step: Step, start: Start };
