/** Whether the open program starts by itself, for those that say when. */
import { ArmSwitch } from "@/app/ArmSwitch";
import { useOpenProgram } from "../state/context";

export function Arm() {
  const { program, site, document } = useOpenProgram();
  const starts = Object.values(document.steps).some(
    (step) => step.kind === "on_event" && step.params.starts === "run" && step.place,
  );
  return (
    <ArmSwitch site={site.slug} program={{ id: program.id, kinds: starts ? ["on_event"] : [] }} role={site.role} />
  );
}
