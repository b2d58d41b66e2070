/** Whether the open program begins by itself when its event comes. */
import { lazy, Suspense } from "react";
import { useArmed } from "@/api/queries";
import { useOpenProgram } from "../state/context";

/** Loaded where a program begins by itself, or could. */
const ArmSwitch = lazy(async () => ({ default: (await import("@/shell/ArmSwitch")).ArmSwitch }));

export function Arm() {
  const { program, shared, site, document } = useOpenProgram();
  const armed = useArmed(site.slug).data?.some((each) => each.program === program.id);
  const starts = Object.values(document.steps).some(
    (step) => step.kind === "on_event" && step.params.starts === "run" && step.place,
  );
  if (!starts && !armed) return null;
  return (
    <Suspense fallback={null}>
      <ArmSwitch
        site={site.slug}
        program={{ id: program.id, kinds: starts ? ["on_event"] : [] }}
        role={site.role}
        stored={() => shared.stored()}
      />
    </Suspense>
  );
}
