/** The kinds of node on the map: machines, steps, the start. */
import { Handle, Position, type Node, type NodeProps } from "@xyflow/react";
import { Play } from "lucide-react";
import classes from "./stage.module.css";
import { MachineNode, type MachineNodeProps } from "./MachineNode";
import { StepChip, type StepChipProps } from "./StepChip";

export type MachineFlowNode = Node<MachineNodeProps & Record<string, unknown>, "machine">;
export type StepFlowNode = Node<StepChipProps & { joinable: boolean } & Record<string, unknown>, "step">;
export type StartFlowNode = Node<{ label: string }, "start">;
export type StageNode = MachineFlowNode | StepFlowNode | StartFlowNode;

function Machine({ data }: NodeProps<MachineFlowNode>) {
  return <MachineNode device={data.device} light={data.light} caption={data.caption} side={data.side} gap={data.gap} />;
}

function Step({ data }: NodeProps<StepFlowNode>) {
  return (
    <>
      <StepChip chip={data.chip} selected={data.selected} state={data.state} other={data.other} note={data.note} />
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
    <div className={classes.start}>
      <Play size={14} strokeWidth={2} aria-hidden="true" />
      <span>{data.label}</span>
      <Handle type="source" position={Position.Bottom} className={classes.dot} />
    </div>
  );
}

export const nodeTypes = { machine: Machine, step: Step, start: Start };
