/** A function made anew at a site where one may draw; it keeps which one it was made from. */
import { Button, Modal, NativeSelect, TextInput } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { useState, type FormEvent } from "react";
import { useTranslation } from "react-i18next";
import { useNavigate } from "react-router-dom";
import { api } from "@/api/client";
import { useSites } from "@/api/queries";
import type { LibraryFunction } from "@/api/types";
import { problemText } from "@/shell/LoadProblem";
import { useTellUnseen } from "@/shell/refusal";
import pages from "../pages.module.css";

const DRAW: readonly string[] = ["author", "admin"];

export function CopyToSite({ slug, item, onClose }: { slug: string; item: LibraryFunction; onClose: () => void }) {
  const { t } = useTranslation();
  const sites = (useSites().data ?? []).filter((site) => DRAW.includes(site.role));
  const first =
    sites.find((site) => site.slug === slug && site.slug !== item.site) ??
    sites.find((s) => s.slug !== item.site) ??
    sites[0];
  const [chosen, setChosen] = useState("");
  const [name, setName] = useState(item.name);
  const site = chosen || (first?.slug ?? "");
  const copy = useCopy({ site, name: name.trim(), item, onClose });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    copy.mutate();
  };
  return (
    <Modal opened onClose={onClose} title={t("library.copy.title", { name: item.name })} size={440}>
      <form onSubmit={submit} className={pages.form}>
        <p className={pages.sub}>
          {sites.length > 0
            ? t("library.copy.text", { name: item.name, version: item.version })
            : t("library.copy.none")}
        </p>
        <NativeSelect
          data-autofocus
          label={t("library.copy.site")}
          disabled={sites.length === 0}
          data={sites.map((each) => ({ value: each.slug, label: each.name }))}
          value={site}
          onChange={(event) => setChosen(event.currentTarget.value)}
        />
        <TextInput
          label={t("library.copy.name")}
          maxLength={120}
          value={name}
          error={copy.isError ? problemText(copy.error, t("shell.problem.screen")) : null}
          onChange={(event) => setName(event.currentTarget.value)}
        />
        <Button type="submit" disabled={!name.trim() || !site} loading={copy.isPending}>
          {t("library.copy.do")}
        </Button>
      </form>
    </Modal>
  );
}

function useCopy(wanted: { site: string; name: string; item: LibraryFunction; onClose: () => void }) {
  const { t } = useTranslation();
  const { site, name, item, onClose } = wanted;
  const queries = useQueryClient();
  const navigate = useNavigate();
  return useMutation({
    mutationFn: () =>
      api.post<LibraryFunction>(`/sites/${site}/library/forks`, { function: item.id, version: item.version, name }),
    onSuccess: async (made) => {
      await queries.invalidateQueries({ queryKey: ["library"] });
      notifications.show({ message: t("library.copy.done", { site: made.site }) });
      onClose();
      void navigate(`/sites/${made.site}/library/${made.id}`);
    },
    onError: useTellUnseen(),
  });
}
