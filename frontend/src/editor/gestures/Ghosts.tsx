/** Steps that somebody else took away while this person had them selected or had changed them: still there to be kept. */
import { Suspense, useEffect } from "react";
import { beside } from "@/design/useFetchLater";
import { outermost } from "@/program/document/tree";
import { type OpenProgram, useOpenProgram } from "../state/context";
import { select, useUi } from "../state/ui";
import { useGestures, type Ghost } from "../state/gestures";
import type { ProgramDocument } from "@/program/document/document";
import { isSameValue } from "@/program/document/sameValue";
import { copiesOf, keptOf } from "./keptSteps";

// Fetched with the dialogs, of whose script it is a part.
const GhostCard = beside(async () => (await import("./GhostCard")).GhostCard);

export function Ghosts() {
  const { shared, scene, canEdit } = useOpenProgram();
  const ghosts = useGestures((ui) => ui.ghosts);
  useEffect(() => shared.onRemoval((...change) => keepGhosts({ shared, scene }, ...change)), [shared, scene]);
  return canEdit ? (
    <Suspense fallback={null}>
      {ghosts.map((ghost) => (
        <GhostCard key={ghost.id} ghost={ghost} />
      ))}
    </Suspense>
  ) : null;
}

/** The document that others read is still the one before: it is read anew only when the transaction has ended. */
function keepGhosts(
  { shared, scene }: Pick<OpenProgram, "shared" | "scene">,
  gone: readonly string[],
  brought: ProgramDocument["steps"],
): void {
  const before = shared.getDocument();
  const { selected } = useUi.getState();
  const copies = copiesOf(before, gone, brought);
  // Who was at a step that only has another name now goes on with it; a change that went is told all the same.
  const concerns = (id: string) => shared.isUnsaved(id) || (selected.includes(id) && !copies.has(id));
  const lost = outermost(
    before,
    gone.filter((id) => concerns(id) && Object.hasOwn(before.steps, id)),
  );
  const stays = selected.flatMap((id) => (gone.includes(id) ? (copies.get(id) ?? []) : [id]));
  if (lost.length === 0 && isSameValue(stays, selected)) return;
  const fresh = lost.map((id): Ghost => {
    const at = scene.chips.get(id)?.at;
    return { id, steps: keptOf(before, id, gone), at, changed: shared.isUnsaved(id) };
  });
  useGestures.setState(({ ghosts }) => ({ ghosts: [...ghosts.filter(({ id }) => !lost.includes(id)), ...fresh] }));
  select(stays);
}
