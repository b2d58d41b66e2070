/** A new program: its name, then the editor. */
import { Button, Modal, TextInput } from "@mantine/core";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { Plus } from "lucide-react";
import { useState, type FormEvent } from "react";
import { useTranslation } from "react-i18next";
import { useNavigate } from "react-router-dom";
import { api } from "@/api/client";
import { keys, useSite } from "@/api/queries";
import type { Program, Role } from "@/api/types";
import { problemText } from "@/shell/LoadProblem";
import { useTellUnseen } from "@/shell/refusal";

/** Whether the role may edit programs. */
export function mayEdit(role: Role | undefined): boolean {
  return role === "author" || role === "admin";
}

/** Makes a program and opens it; `onRefused` is called also where the caller is gone by then. */
export function useCreateProgram(slug: string, onRefused: (error: Error) => void) {
  const queries = useQueryClient();
  const navigate = useNavigate();
  return useMutation({
    mutationFn: (name: string) => api.post<Program>(`/sites/${slug}/programs`, { name }),
    onSuccess: async (program) => {
      void queries.invalidateQueries({ queryKey: keys.programs(slug) });
      await navigate(`/programs/${program.id}`);
    },
    onError: onRefused,
  });
}

export function NewProgramButton({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const site = useSite(slug).data;
  const [opened, setOpened] = useState(false);
  if (!mayEdit(site?.role)) return null;
  return (
    <>
      <Button leftSection={<Plus size={16} />} onClick={() => setOpened(true)}>
        {t("pages.programs.new")}
      </Button>
      <Modal opened={opened} onClose={() => setOpened(false)} title={t("pages.programs.new")} size={420}>
        <NewProgramForm slug={slug} />
      </Modal>
    </>
  );
}

function NewProgramForm({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const [name, setName] = useState("");
  const create = useCreateProgram(slug, useTellUnseen());
  const submit = (event: FormEvent) => {
    event.preventDefault();
    create.mutate(name.trim() || t("pages.programs.untitled"));
  };
  return (
    <form onSubmit={submit} style={{ display: "grid", gap: 16 }}>
      <TextInput
        data-autofocus
        label={t("pages.programs.name")}
        placeholder={t("pages.programs.untitled")}
        maxLength={100}
        value={name}
        error={create.isError ? problemText(create.error, t("shell.problem.screen")) : null}
        onChange={(event) => setName(event.target.value)}
      />
      <Button type="submit" loading={create.isPending}>
        {t("pages.programs.create")}
      </Button>
    </form>
  );
}
