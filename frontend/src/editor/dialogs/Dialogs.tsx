/** The dialogs of the editor; what they are made of is loaded once the program is on the screen. */
import { type ComponentType, lazy, Suspense, useEffect, useState } from "react";
import { useFetchLater } from "@/design/useFetchLater";
import { loadScreenTexts } from "@/i18n";
import { useTypedAhead } from "@/shell/keys/typedAhead";
import { useOpenProgram } from "../state/context";
import { RESTING } from "../state/tool";
import { type Dialog, useUi } from "../state/ui";
import { useAskedFunction } from "./askedFunction";

type Name = NonNullable<Dialog>;

/** A dialog that other screens have, too: its texts are theirs. */
async function withTexts<T>(module: Promise<T>): Promise<T> {
  return (await Promise.all([module, loadScreenTexts()]))[0];
}

const LOAD = {
  run: () => withTexts(import("./RunDialog").then(({ RunDialog }) => ({ default: RunDialog }))),
  rehearse: () => withTexts(import("./RehearseDialog").then(({ RehearseDialog }) => ({ default: RehearseDialog }))),
  function: () => import("./FunctionDialog").then(({ FunctionDialog }) => ({ default: FunctionDialog })),
  library: () => import("./LibraryDialog").then(({ LibraryDialog }) => ({ default: LibraryDialog })),
  save_function: () =>
    import("./SaveFunctionDialog").then(({ SaveFunctionDialog }) => ({ default: SaveFunctionDialog })),
  strangers: () => withTexts(import("./StrangersDialog").then(({ StrangersDialog }) => ({ default: StrangersDialog }))),
  find: () => withTexts(import("./FindDialog").then(({ FindDialog }) => ({ default: FindDialog }))),
  shortcuts: () => import("./ShortcutsDialog").then(({ ShortcutsDialog }) => ({ default: ShortcutsDialog })),
  templates: () =>
    withTexts(import("../beginning/TemplateDialog").then(({ TemplateDialog }) => ({ default: TemplateDialog }))),
};
const DIALOGS: Record<Name, ComponentType> = {
  run: lazy(LOAD.run),
  rehearse: lazy(LOAD.rehearse),
  function: lazy(LOAD.function),
  library: lazy(LOAD.library),
  save_function: lazy(LOAD.save_function),
  strangers: lazy(LOAD.strangers),
  find: lazy(LOAD.find),
  shortcuts: lazy(LOAD.shortcuts),
  templates: lazy(LOAD.templates),
};
const LOADS = Object.values(LOAD);
const closeDialog = () => useUi.setState({ dialog: null, dialogFunction: null, gesture: RESTING });

export function Dialogs() {
  const { canEdit } = useOpenProgram();
  const { asked } = useAskedFunction(canEdit);
  const now = useUi((ui) => ui.dialog);
  const [opened, setOpened] = useState<readonly Name[]>([]);
  // One that was open stays, so that it is seen to close.
  if (now && !opened.includes(now)) setOpened([...opened, now]);
  useEffect(() => {
    if (asked) useUi.setState({ dialog: "library" });
  }, [asked]);
  useFetchLater(LOADS);
  useTypedAhead(now !== null, closeDialog);
  return opened.map((name) => {
    const Shown = DIALOGS[name];
    return (
      <Suspense key={name} fallback={null}>
        <Shown />
      </Suspense>
    );
  });
}
