/** Whether the server does not take the changes made here, or no longer takes them. */
import { lazy, Suspense, useSyncExternalStore } from "react";
import { useFetchLater } from "@/design/useFetchLater";
import { reasonOf } from "../shared/refusal";
import { useOpenProgram } from "../state/context";

const loadPanel = () => import("./NotTakenPanel");
const LOADS = [loadPanel];
const Panel = lazy(async () => ({ default: (await loadPanel()).NotTakenPanel }));

export function NotTaken() {
  useFetchLater(LOADS);
  const { shared } = useOpenProgram();
  const saving = useSyncExternalStore(shared.subscribeSaving, shared.getSaving);
  const reason = reasonOf(saving);
  return reason ? (
    <Suspense fallback={null}>
      <Panel reason={reason} waiting={saving.waiting} />
    </Suspense>
  ) : null;
}
