/** What somebody else took away, where it stood: to be kept or let go. */
import { useEffect } from "react";
import { toPixels } from "@/map/plane/projection";
import { putBack } from "./keptSteps";
import type { SharedProgram } from "../shared/sharedProgram";
import { useOpenProgram } from "../state/context";
import { type Ghost, useGestures } from "../state/gestures";
import { select } from "../state/ui";
import { FloatAt } from "../canvas/FloatAt";
import classes from "../canvas/gestures.module.css";

export function GhostCard({ ghost }: { ghost: Ghost }) {
  const { document, apply, shared, people, t } = useOpenProgram();
  const step = ghost.steps[ghost.id];
  const back = Object.hasOwn(document.steps, ghost.id);
  useEffect(() => {
    if (back) letGo(ghost.id);
  }, [back, ghost.id]);
  const remover = people.find((person) => !person.me && removedBy(shared, person.client).includes(ghost.id));
  if (!step || back) return null;
  const words = ghost.changed ? "gesture.ghost.changed_" : "gesture.ghost.";
  const keep = () => {
    apply(putBack(document, ghost.steps));
    letGo(ghost.id);
    select([ghost.id]);
  };
  return (
    <FloatAt at={ghost.at ?? toPixels(step.pos ?? [1, -1])}>
      <div className={classes.ghost} role="alert">
        {remover ? t(`${words}by`, { name: remover.name }) : t(`${words}by_somebody`)}
        <button type="button" onClick={keep}>
          {t("gesture.ghost.keep")}
        </button>
        <button type="button" onClick={() => letGo(ghost.id)}>
          {t("gesture.ghost.let_go")}
        </button>
      </div>
    </FloatAt>
  );
}

function letGo(id: string): void {
  useGestures.setState(({ ghosts }) => ({ ghosts: ghosts.filter((each) => each.id !== id) }));
}

function removedBy(shared: SharedProgram, client: number): readonly unknown[] {
  const state = shared.awareness.getStates().get(client) as { removed?: unknown } | undefined;
  return Array.isArray(state?.removed) ? state.removed : [];
}
