/** A version as a program of its own. */
import { Button, Modal, TextInput } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { useState, type FormEvent } from "react";
import { useTranslation } from "react-i18next";
import { useNavigate } from "react-router-dom";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import type { Program, Version } from "@/api/types";
import { problemText } from "@/shell/LoadProblem";
import { useTellUnseen } from "@/shell/refusal";
import styles from "../pages.module.css";

interface CopyProps {
  version: Version;
  program: Program;
  onClose: () => void;
}

export function CopyVersion({ version, program, onClose }: CopyProps) {
  const { t } = useTranslation();
  const queries = useQueryClient();
  const navigate = useNavigate();
  const [name, setName] = useState(() => t("history.copy_name", { name: program.name, number: version.number }));
  const copy = useMutation({
    mutationFn: () => api.post<Program>(`/programs/${program.id}/versions/${version.number}/copy`, { name }),
    onSuccess: (made) => {
      notifications.show({ message: t("history.copied", { name: made.name }) });
      void queries.invalidateQueries({ queryKey: keys.programs(program.site) });
      return navigate(`/programs/${made.id}`);
    },
    onError: useTellUnseen(),
  });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    copy.mutate();
  };
  return (
    <Modal opened onClose={onClose} title={t("history.copy")} size={420}>
      <form onSubmit={submit} className={styles.form}>
        <TextInput
          data-autofocus
          label={t("history.name")}
          maxLength={100}
          value={name}
          error={copy.isError ? problemText(copy.error, t("shell.problem.screen")) : null}
          onChange={(event) => setName(event.target.value)}
        />
        <Button type="submit" disabled={!name.trim()} loading={copy.isPending}>
          {t("history.copy")}
        </Button>
      </form>
    </Modal>
  );
}
