/** Draw again what a version held: what it needs is asked first; each restore can be taken back, the last one first. */
import { notifications } from "@mantine/notifications";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import type { ConstructChange, Restored, ValueChange } from "@/api/types";
import { problemText } from "@/shell/LoadProblem";

/** What shall be restored: all, a construct, or a single field of one. */
export type Wanted =
  | { readonly what: "all" }
  | { readonly what: "construct"; readonly change: ConstructChange }
  | { readonly what: "field"; readonly change: ConstructChange; readonly path: readonly string[] };

/** What shall be restored, and out of which version: another one may be chosen before the answer comes. */
interface Order {
  readonly wanted: Wanted;
  readonly version: number;
}

/** A restore that waits for a person's word. */
export interface Asked extends Order {
  readonly found: Restored;
}

export interface Restore {
  readonly asked: Asked | null;
  readonly busy: boolean;
  readonly ask: (wanted: Wanted) => void;
  readonly confirm: () => void;
  readonly close: () => void;
  readonly undo: () => void;
  readonly canUndo: boolean;
}

function bodyOf(wanted: Wanted): object {
  if (wanted.what === "all") return { everything: true };
  if (wanted.what === "field") return { fields: [wanted.path] };
  return { constructs: [[wanted.change.root, wanted.change.id]] };
}

/** What takes changes back. */
export function reversed(changes: readonly ValueChange[]): ValueChange[] {
  return changes.map((change) => ({
    path: change.path,
    ...("new" in change ? { old: change.new } : {}),
    ...("old" in change ? { new: change.old } : {}),
  }));
}

/** The calls: restoring, looking at what it would do, and taking changes back. */
function useCalls(program: string) {
  const { t } = useTranslation();
  const queries = useQueryClient();
  const send = ({ wanted, version }: Order, address: "restore" | "restore/look") =>
    api.post<Restored>(`/programs/${program}/versions/${version}/${address}`, bodyOf(wanted));
  const onError = (error: Error) =>
    notifications.show({ color: "red", message: problemText(error, t("shell.problem.screen")) });
  const onSuccess = () => {
    void queries.invalidateQueries({ queryKey: keys.comparison(program) });
    void queries.invalidateQueries({ queryKey: keys.versions(program) });
  };
  const restore = useMutation({
    mutationFn: (order: Order) => send(order, "restore"),
    onSuccess,
    onError,
  });
  const look = useMutation({
    mutationFn: (order: Order) => send(order, "restore/look"),
    onError,
  });
  const back = useMutation({
    mutationFn: (changes: readonly ValueChange[]) =>
      api.post<Restored>(`/programs/${program}/changes`, { changes: reversed(changes) }),
    onSuccess,
    onError,
  });
  return { restore, look, back, busy: restore.isPending || look.isPending || back.isPending };
}

/** `always` to ask even where nothing else is needed: what is drawn now is not what is looked at. */
export function useRestore(program: string, version: number | null, always: boolean, onDone: () => void): Restore {
  const { t } = useTranslation();
  const { restore, look, back, busy } = useCalls(program);
  const [asked, setAsked] = useState<Asked | null>(null);
  const [done, setDone] = useState<readonly (readonly ValueChange[])[]>([]);
  const last = done.at(-1);
  const begin = (order: Order) =>
    restore.mutate(order, {
      onSuccess: ({ changes }) => {
        setAsked(null);
        setDone((before) => [...before, changes]);
        notifications.show({ message: t("compare.restored", { count: changes.length }) });
        onDone();
      },
    });
  const ask = (order: Order) =>
    look.mutate(order, {
      onSuccess: (found) => {
        if (found.needs.length > 0 || order.wanted.what === "all" || always) setAsked({ ...order, found });
        else begin(order);
      },
    });
  const undo = (changes: readonly ValueChange[]) =>
    back.mutate(changes, {
      onSuccess: ({ skipped }) => {
        setDone((before) => before.slice(0, -1));
        const left = skipped.length;
        notifications.show({ message: left > 0 ? t("compare.undone_but", { count: left }) : t("compare.undone") });
      },
    });
  return {
    asked,
    busy,
    ask: (wanted) => version !== null && !busy && ask({ wanted, version }),
    confirm: () => asked && !busy && begin(asked),
    close: () => setAsked(null),
    undo: () => last && !busy && undo(last),
    canUndo: last !== undefined,
  };
}
