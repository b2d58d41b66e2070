/** A function of this program saved to the site's library, for other programs and people. */
import { Button, Modal, NativeSelect, Textarea, TextInput } from "@mantine/core";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import type { LibraryFunction } from "@/api/types";
import { VISIBILITIES, type Visibility } from "@/program/visibility";
import { isBreaking, reasonWords } from "@/program/words/libraryWords";
import { useOpenProgram } from "../state/context";
import { say, useUi } from "../state/ui";
import classes from "./dialogs.module.css";
import { useScreenTexts } from "./screenTexts";

export function SaveFunctionDialog() {
  const { t } = useOpenProgram();
  const opened = useUi((ui) => ui.dialog === "save_function");
  const functionId = useUi((ui) => ui.dialogFunction);
  const close = () => useUi.setState({ dialog: null, dialogFunction: null });
  return (
    <Modal opened={opened} onClose={close} title={t("save.title")}>
      {functionId ? <Form functionId={functionId} onDone={close} /> : null}
    </Modal>
  );
}

function Form({ functionId, onDone }: { functionId: string; onDone: () => void }) {
  const { t, document } = useOpenProgram();
  const known = document.functions[functionId]?.name ?? "";
  const [name, setName] = useState(known);
  const [description, setDescription] = useState("");
  useEffect(() => setName(known), [known]);
  const [visibility, setVisibility] = useState<Visibility | "">("");
  const save = useSave(functionId, { name, description, visibility }, onDone);
  if (save.data?.reasons) return <Saved saved={save.data} onDone={onDone} />;
  return (
    <form
      className={classes.content}
      onSubmit={(event) => {
        event.preventDefault();
        save.mutate();
      }}
    >
      <TextInput
        label={t("save.name")}
        value={name}
        data-autofocus
        onChange={(event) => setName(event.currentTarget.value)}
      />
      <Textarea
        label={t("save.description")}
        placeholder={t("save.example")}
        value={description}
        onChange={(event) => setDescription(event.currentTarget.value)}
      />
      <NativeSelect
        label={t("save.visible_to")}
        value={visibility}
        data={["" as const, ...VISIBILITIES].map((value) => ({
          value,
          label: t(`save.visibility.${value || "as_was"}`),
        }))}
        onChange={(event) => setVisibility(event.currentTarget.value as Visibility | "")}
      />
      {save.error ? (
        <p className={classes.problem} role="alert">
          {save.error.message}
        </p>
      ) : null}
      <div className={classes.buttons}>
        <Button variant="default" onClick={onDone}>
          {t("cancel")}
        </Button>
        <Button type="submit" loading={save.isPending} disabled={!name.trim()}>
          {t("save.action")}
        </Button>
      </div>
    </form>
  );
}

/** What was saved, and whether programs that hold the version before can take it as they are. */
function Saved({ saved, onDone }: { saved: LibraryFunction; onDone: () => void }) {
  const { t } = useTranslation();
  const reasons = saved.reasons ?? [];
  const breaks = isBreaking(reasons);
  return useScreenTexts() ? (
    <div className={classes.content}>
      <p role="status">
        {t("library.saved", { version: saved.version })}{" "}
        {t(breaks ? "library.savedBreaking" : "library.savedCompatible")}
      </p>
      <ul className={classes.reasons}>
        {reasons.map((reason) => (
          <li key={`${reason.code}/${reason.name}`}>{reasonWords(t, reason)}</li>
        ))}
      </ul>
      <div className={classes.buttons}>
        <Button data-autofocus onClick={onDone}>
          {t("library.close")}
        </Button>
      </div>
    </div>
  ) : null;
}

interface Said {
  name: string;
  description: string;
  visibility: Visibility | "";
}

function useSave(functionId: string, said: Said, onDone: () => void) {
  const { t, program, shared, site } = useOpenProgram();
  const queries = useQueryClient();
  return useMutation({
    mutationFn: async () => {
      await shared.stored();
      return api.post<LibraryFunction>(`/sites/${site.slug}/library`, {
        program: program.id,
        function: functionId,
        name: said.name.trim(),
        description: said.description.trim(),
        visibility: said.visibility || null,
      });
    },
    onSuccess: (saved) => {
      void queries.invalidateQueries({ queryKey: ["library"] });
      say(t("save.done", { name: saved.name, version: saved.version }));
      if (!saved.reasons) onDone(); // of a first version there is nothing more to tell
    },
  });
}
