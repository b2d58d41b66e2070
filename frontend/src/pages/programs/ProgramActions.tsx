/** What can be done with a program of a list: another name, and deleting it after a question. */
import { Button, Menu, Modal, TextInput } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { Ellipsis, Pencil, Send, Trash2 } from "lucide-react";
import { useState, type FormEvent } from "react";
import { useTranslation } from "react-i18next";
import { problemText } from "@/shell/LoadProblem";
import { useTellUnseen } from "@/shell/refusal";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import type { Program } from "@/api/types";
import { IconButton } from "@/design/IconButton";
import styles from "../pages.module.css";
import { PromoteProgram } from "./PromoteProgram";

interface DialogProps {
  program: Program;
  onClose: () => void;
}

/** Sends a change of the list, says that it is done, and closes the dialog, where a refusal stays while it is open. */
function useChange<T>(program: Program, change: (value: T) => Promise<unknown>, done: string, onClose: () => void) {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: change,
    onSuccess: () => {
      notifications.show({ message: done });
      void queries.invalidateQueries({ queryKey: keys.programs(program.site) });
      void queries.invalidateQueries({ queryKey: keys.program(program.id) });
      onClose();
    },
    onError: useTellUnseen(),
  });
}

function RenameProgram({ program, onClose }: DialogProps) {
  const { t } = useTranslation();
  const [name, setName] = useState(program.name);
  const rename = useChange(
    program,
    (wanted: string) => api.patch(`/programs/${program.id}`, { name: wanted }),
    t("pages.programs.renamed"),
    onClose,
  );
  const submit = (event: FormEvent) => {
    event.preventDefault();
    rename.mutate(name.trim());
  };
  return (
    <Modal opened onClose={onClose} title={t("pages.programs.rename")} size={420}>
      <form onSubmit={submit} className={styles.form}>
        <TextInput
          data-autofocus
          label={t("pages.programs.name")}
          maxLength={100}
          value={name}
          error={rename.isError ? problemText(rename.error, t("shell.problem.screen")) : null}
          onChange={(event) => setName(event.target.value)}
        />
        <Button type="submit" disabled={!name.trim()} loading={rename.isPending}>
          {t("pages.programs.rename")}
        </Button>
      </form>
    </Modal>
  );
}

function DeleteProgram({ program, onClose }: DialogProps) {
  const { t } = useTranslation();
  const remove = useChange(
    program,
    (id: string) => api.delete(`/programs/${id}`),
    t("pages.programs.deleted", { name: program.name }),
    onClose,
  );
  return (
    <Modal opened onClose={onClose} title={t("pages.programs.deleteAsk", { name: program.name })} size={440}>
      <div className={styles.form}>
        <p>{t("pages.programs.deleteText")}</p>
        {remove.isError ? <p role="alert">{problemText(remove.error, t("shell.problem.screen"))}</p> : null}
        <div className={styles.buttons}>
          <Button data-autofocus variant="default" onClick={onClose}>
            {t("pages.programs.keep")}
          </Button>
          <Button className={styles.danger} loading={remove.isPending} onClick={() => remove.mutate(program.id)}>
            {t("pages.programs.delete")}
          </Button>
        </div>
      </div>
    </Modal>
  );
}

export function ProgramActions({ program }: { program: Program }) {
  const { t } = useTranslation();
  const [asks, setAsks] = useState<"rename" | "promote" | "delete" | null>(null);
  const close = () => setAsks(null);
  return (
    <>
      <Menu position="bottom-end" width={210}>
        <Menu.Target>
          <IconButton label={t("pages.programs.actions", { name: program.name })}>
            <Ellipsis size={17} aria-hidden="true" />
          </IconButton>
        </Menu.Target>
        <Menu.Dropdown>
          <Menu.Item leftSection={<Pencil size={15} />} onClick={() => setAsks("rename")}>
            {t("pages.programs.rename")}
          </Menu.Item>
          <Menu.Item leftSection={<Send size={15} />} onClick={() => setAsks("promote")}>
            {t("promote.action")}
          </Menu.Item>
          <Menu.Item leftSection={<Trash2 size={15} />} color="var(--error)" onClick={() => setAsks("delete")}>
            {t("pages.programs.delete")}
          </Menu.Item>
        </Menu.Dropdown>
      </Menu>
      {asks === "rename" ? <RenameProgram program={program} onClose={close} /> : null}
      {asks === "promote" ? <PromoteProgram program={program} onClose={close} /> : null}
      {asks === "delete" ? <DeleteProgram program={program} onClose={close} /> : null}
    </>
  );
}
