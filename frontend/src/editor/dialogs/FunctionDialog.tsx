/** Functions: make one of the selected steps, call one that is there, or bring one from the library. */
import { Button, Modal, TextInput } from "@mantine/core";
import { Library } from "lucide-react";
import { useEffect, useState } from "react";
import { wrapInFunction } from "../edits/calls";
import { createStep, makeId } from "../state/actions";
import { freeSpot } from "../state/freeSpot";
import { useOpenProgram } from "../state/context";
import { RESTING } from "../state/tool";
import { select, useUi } from "../state/ui";
import classes from "./dialogs.module.css";

export function FunctionDialog() {
  const { t } = useOpenProgram();
  const opened = useUi((ui) => ui.dialog === "function");
  const close = () => useUi.setState({ dialog: null, gesture: RESTING });
  return (
    <Modal opened={opened} onClose={close} title={t("function.title")}>
      <div className={classes.content}>
        <MakeFunction onDone={close} />
        <CallExisting onDone={close} />
        <Button
          variant="default"
          leftSection={<Library size={15} aria-hidden="true" />}
          onClick={() => useUi.setState({ dialog: "library", gesture: RESTING })}
        >
          {t("function.from_library")}
        </Button>
      </div>
    </Modal>
  );
}

function MakeFunction({ onDone }: { onDone: () => void }) {
  const { t, document, apply } = useOpenProgram();
  const selected = useUi((ui) => ui.selected);
  const [name, setName] = useState("");
  const [problem, setProblem] = useState<string | null>(null);
  useEffect(() => setProblem(null), [selected]);
  if (selected.length === 0) return <p>{t("function.select_first")}</p>;
  const make = () => {
    const callId = makeId();
    const decision = wrapInFunction(document, selected, { functionId: makeId(), callId, name: name.trim() });
    if ("refused" in decision) {
      setProblem(t(`refused.${decision.refused}`));
      return;
    }
    apply(decision.edits);
    select([callId]);
    setName("");
    onDone();
  };
  return (
    <form
      className={classes.content}
      onSubmit={(event) => {
        event.preventDefault();
        if (name.trim()) make();
      }}
    >
      <TextInput
        label={t("function.name", { count: selected.length })}
        placeholder={t("function.example")}
        value={name}
        error={problem}
        data-autofocus
        onChange={(event) => setName(event.currentTarget.value)}
      />
      <div className={classes.buttons}>
        <Button type="submit" disabled={!name.trim()}>
          {t("function.make")}
        </Button>
      </div>
    </form>
  );
}

function CallExisting({ onDone }: { onDone: () => void }) {
  const open = useOpenProgram();
  const { t, document, apply } = open;
  const functions = Object.entries(document.functions);
  if (functions.length === 0) return null;
  const call = (id: string) => {
    createStep(document, apply, { kind: "call", pos: freeSpot(open), params: { function: id, args: {} } });
    onDone();
  };
  return (
    <section className={classes.content} aria-label={t("function.call")}>
      <strong>{t("function.call")}</strong>
      <ul className={classes.functions}>
        {functions.map(([id, definition]) => (
          <li key={id}>
            <button type="button" className={classes.function} onClick={() => call(id)}>
              <strong>{definition.name}</strong>
              <span>{definition.parameters.map((each) => each.name).join(", ") || t("function.no_parameters")}</span>
            </button>
          </li>
        ))}
      </ul>
    </section>
  );
}
