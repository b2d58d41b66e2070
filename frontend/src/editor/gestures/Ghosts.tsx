/** Steps that somebody else took away while this person had them selected or had changed them: still there to be kept. */
import { useEffect } from "react";
import { toPixels } from "@/map/plane/projection";
import { FloatAt } from "../canvas/FloatAt";
import type { SharedProgram } from "../shared/sharedProgram";
import { outermost } from "@/program/document/tree";
import { useOpenProgram } from "../state/context";
import { select, useUi } from "../state/ui";
import classes from "../canvas/gestures.module.css";
import { useGestures, type Ghost } from "../state/gestures";
import type { ProgramDocument } from "@/program/document/document";
import { isSameValue } from "@/program/document/sameValue";
import { copyAmong, keptOf, putBack } from "./keptSteps";

export function Ghosts() {
  const { shared, canEdit } = useOpenProgram();
  const ghosts = useGestures((ui) => ui.ghosts);
  useEffect(() => shared.onRemoval((...change) => keepGhosts(shared, ...change)), [shared]);
  return canEdit ? ghosts.map((ghost) => <GhostCard key={ghost.id} ghost={ghost} />) : null;
}

/** The document that others read is still the one before: it is read anew only when the transaction has ended. */
function keepGhosts(shared: SharedProgram, gone: readonly string[], brought: ProgramDocument["steps"]): void {
  const before = shared.getDocument();
  const { selected } = useUi.getState();
  const copyOf = (id: string) => before.steps[id] && copyAmong(brought, before.steps[id]);
  // Who was at a step that only has another name now goes on with it; a change that went is told all the same.
  const concerns = (id: string) => shared.isUnsaved(id) || (selected.includes(id) && !copyOf(id));
  const lost = outermost(
    before,
    gone.filter((id) => concerns(id) && Object.hasOwn(before.steps, id)),
  );
  const stays = selected.flatMap((id) => (gone.includes(id) ? (copyOf(id) ?? []) : [id]));
  if (lost.length === 0 && isSameValue(stays, selected)) return;
  const fresh = lost.map((id): Ghost => ({ id, steps: keptOf(before, id, gone), changed: shared.isUnsaved(id) }));
  useGestures.setState(({ ghosts }) => ({ ghosts: [...ghosts.filter(({ id }) => !lost.includes(id)), ...fresh] }));
  select(stays);
}

function GhostCard({ ghost }: { ghost: Ghost }) {
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
    <FloatAt at={toPixels(step.pos ?? [1, -1])}>
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
