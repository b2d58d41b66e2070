/** A new site: out of a map, or empty. */
import { Button, TextInput } from "@mantine/core";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { Building2 } from "lucide-react";
import { useState, type FormEvent } from "react";
import { useTranslation } from "react-i18next";
import { useNavigate } from "react-router-dom";
import { problemText } from "@/shell/LoadProblem";
import { keepSite } from "@/shell/currentSite";
import { PageShell } from "@/shell/PageShell";
import { api, ApiProblem } from "@/api/client";
import { keys, useMe } from "@/api/queries";
import type { Site } from "@/api/types";
import { EmptyState } from "@/design/EmptyState";
import { Panel } from "@/design/Panel";
import { nameFrom } from "./files";
import { MapChoiceFields, MapChoicePreview } from "./MapChoiceParts";
import styles from "./newsite.module.css";
import { useMapChoice } from "./useMapChoice";

function useCreateSite() {
  const queries = useQueryClient();
  const navigate = useNavigate();
  return useMutation({
    mutationFn: ({ name, form }: { name: string; form: FormData }) => {
      form.set("name", name);
      return api.upload<Site>("/sites", form);
    },
    onSuccess: async (site) => {
      await queries.invalidateQueries({ queryKey: keys.sites });
      await queries.invalidateQueries({ queryKey: keys.me });
      keepSite(site.slug);
      await navigate(site.has_map ? `/sites/${site.slug}/map` : "/");
    },
  });
}

function NoRight() {
  const { t } = useTranslation();
  return (
    <Panel>
      <EmptyState icon={<Building2 size={20} />} title={t("pages.newSite.noRight")} text={t("pages.home.askForSite")} />
    </Panel>
  );
}

export function NewSitePage() {
  const { t } = useTranslation();
  const me = useMe().data;
  return (
    <PageShell title={t("shell.site.add")}>{me?.may_create_sites === false ? <NoRight /> : <NewSite />}</PageShell>
  );
}

function NewSite() {
  const { t } = useTranslation();
  const [name, setName] = useState("");
  const choice = useMapChoice();
  const create = useCreateSite();
  const problem = create.isError ? problemText(create.error, t("shell.problem.screen")) : null;
  const aboutName = create.error instanceof ApiProblem && /name|site/.test(create.error.code);
  const choose = (chosen: readonly File[]) => {
    const { yaml, archive, image, drawing } = choice.choose(chosen);
    const named = yaml ?? archive ?? image ?? drawing;
    if (!name && named) setName(nameFrom(named.name));
    create.reset();
  };
  const make = (form: FormData) => create.mutate({ name: name.trim(), form });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    make(choice.makeForm());
  };
  return (
    <div className={styles.page}>
      <Panel className={styles.card}>
        <form onSubmit={submit} className={styles.form}>
          <div>
            <h2>{t("pages.newSite.title")}</h2>
            <p>{t("pages.newSite.text")}</p>
          </div>
          <MapChoiceFields
            choice={choice}
            problem={choice.files.drawing ? t("mapImport.afterSite") : aboutName ? null : problem}
            choose={choose}
          />
          <TextInput
            label={t("pages.newSite.name")}
            placeholder={t("pages.newSite.namePlaceholder")}
            maxLength={100}
            value={name}
            error={aboutName ? problem : null}
            onChange={(event) => setName(event.target.value)}
          />
          <Button type="submit" size="md" disabled={!choice.isReady || !name.trim()} loading={create.isPending}>
            {t("pages.newSite.create")}
          </Button>
          <Button variant="subtle" disabled={!name.trim() || create.isPending} onClick={() => make(new FormData())}>
            {t("mapEdit.withoutMap")}
          </Button>
        </form>
      </Panel>
      <MapChoicePreview choice={choice} />
    </div>
  );
}
