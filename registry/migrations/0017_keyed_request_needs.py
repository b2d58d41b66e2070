from django.db import migrations, models


class Migration(migrations.Migration):
    dependencies = [("registry", "0014_join_key_shown")]

    operations = [migrations.AddField("keyedrequest", "needs", models.JSONField(null=True))]
